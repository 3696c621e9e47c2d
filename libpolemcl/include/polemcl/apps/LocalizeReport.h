#pragma once
/// \file LocalizeReport.h
/// \brief What `pole-localize` writes and prints about its runs.

#include <polemcl/apps/LocalizeApp.h>
#include <polemcl/core/Evaluation.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>
#include <vector>

namespace polemcl::apps {

/// \brief Everything the summary tells, gathered by localize().
struct LocalizeFacts {
  LocalizeJob job;
  LocalizationOptions localization;
  StartOptions start;
  RunOptions runs;
  SequenceCounts counts;
  std::size_t mapPoles = 0;
};

/// \brief `run_00` for run 0; two digits or more.
std::string runName(std::size_t run);

/// \brief See LocalizeApp.h for the layout.
nlohmann::ordered_json makeSummary(const LocalizeFacts& facts, const LocalizeResult& result);

/// \brief See LocalizeApp.h for the columns. Atomic. \throws Error when it cannot be written.
void writeErrorsCsv(const std::filesystem::path& file, const FilterRun& run,
                    const TrajectoryErrors& errors);

/// \brief See LocalizeApp.h for the columns. Atomic. \throws Error when it cannot be written.
void writeCovarianceCsv(const std::filesystem::path& file, const FilterRun& run);
void writeHealthCsv(const std::filesystem::path& file, const FilterRun& run);

/// \brief A row per run, mean and spread; without truth the counts alone.
void printTable(std::ostream& out, const LocalizeFacts& facts, const LocalizeResult& result);

}  // namespace polemcl::apps
