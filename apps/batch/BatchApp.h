#pragma once
/// \file BatchApp.h
/// \brief `pole-batch`: sessions x configurations x runs, from the datasets to the report.

#include <filesystem>
#include <string>
#include <vector>

namespace polemcl::apps {

/// \brief What the command line says.
struct BatchOptions {
  std::filesystem::path batch;   ///< INI, see BatchSpec.h
  std::filesystem::path output;  ///< folder of the batch, see BatchFolder.h
  std::filesystem::path data;    ///< stands for `{data}`; may be empty
  std::vector<std::string> set;  ///< values in place of the INI's, `section.key=value`
  std::size_t jobs = 0;          ///< tasks at the same time; 0: one for each core
  std::size_t imports = 0;       ///< imports at the same time, whose scans lie on disk; 0: no limit
  bool resume = false, slurm = false, quiet = false;
  std::vector<std::string> sbatch;  ///< more arguments for it
};

/// \brief Does what is open of the batch, and writes the report of all that is done.
/// \throws Error as readBatchSpec(), planBatch() and BatchFolder; also when tasks failed, after all
///         others are done and reported: how many, and the first reason.
void doBatch(const BatchOptions& options);

/// \brief The program. \return An ExitCode.
int batchMain(int argc, const char* const* argv);

}  // namespace polemcl::apps
