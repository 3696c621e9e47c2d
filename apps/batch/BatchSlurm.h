#pragma once
/// \file BatchSlurm.h
/// \brief Does the tasks of a batch on a Slurm cluster: job arrays that share the file system
/// alone.

#include <functional>
#include <string>
#include <vector>

#include "batch/BatchFolder.h"
#include "batch/BatchPlan.h"

namespace polemcl::apps {

struct SlurmOptions {
  std::vector<std::string> arguments;  ///< more for `sbatch`, such as `--partition=long`
  std::size_t largestArray = 1000;     ///< tasks in an array, less than Slurm's MaxArraySize
  double pollSeconds = 2;              ///< how often the queue is asked
  double patienceSeconds = 300;        ///< how long `squeue` may fail
};

/// \brief Submits one array for each level of tasks (see levels()), each to begin when the one
/// before has ended, and waits for the last one. Tasks are requeued when their node fails; a task
/// that is done twice leaves the same bytes. Scripts, lists and what `sbatch` says lie in `slurm/`.
/// \param open Tasks to be done, of openTasks().
/// \param progress Called now and then with the number of tasks that are done.
/// \throws Error when `sbatch` cannot be run, or refuses; when `squeue` does so for too long.
void runOnSlurm(const BatchFolder& folder, const BatchPlan& plan,
                const std::vector<const BatchTask*>& open, const SlurmOptions& options,
                const std::function<void(std::size_t)>& progress);

}  // namespace polemcl::apps
