#pragma once
/// \file BatchRunner.h
/// \brief Does the tasks of a batch on this machine, several at a time, each in processes of its
/// own.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "batch/BatchFolder.h"
#include "batch/BatchPlan.h"

namespace polemcl::apps {

/// \brief How a task ended.
struct TaskOutcome {
  std::string failure;   ///< why it failed, one line; empty: it is done
  double seconds = 0;    ///< it took; 0: nothing was to do
  bool blocked = false;  ///< it was not tried, as it needs one that failed
};

/// \brief Folder of the programs: POLEMCL_BIN, or where this program lies.
std::filesystem::path programFolder();

/// \brief Does one task, unless it is done: its commands one after the other in a folder of its
/// own, what they say into its log. Never throws: what goes wrong is the outcome.
TaskOutcome runTask(const BatchFolder& folder, const BatchTask& task);

struct BatchProgress {
  /// Tasks; those that were done before count as done, blocked ones as failed.
  std::size_t done = 0, failed = 0, all = 0;
};

/// \brief How many tasks may be under way at the same time.
struct BatchLimits {
  std::size_t jobs = 1;     ///< at least 1
  std::size_t imports = 0;  ///< of the kind `poles`, which hold a session's scans; 0: any
};

/// \brief Tasks that have to be done: those not done, those damaged, and all that need one of them.
struct OpenTasks {
  std::vector<const BatchTask*> tasks;
  /// Those with old outputs that look complete. Remove them before the work begins, see
  /// BatchFolder::remove().
  std::vector<const BatchTask*> outdated;
  /// A line for each damaged task, and for each other build that did some.
  std::vector<std::string> notes;
};
/// \brief Only looks; nothing is removed.
OpenTasks openTasks(const BatchFolder& folder, const BatchPlan& plan);

/// \brief Does the open tasks, several at a time. A task that needs one that failed fails as well;
/// all others are done. \param all Tasks of the plan. \param report Called after each task, one
/// call at a time, with the task and its outcome. \return The failures by task, blocked ones left
/// out.
std::map<std::string, std::string> runBatch(
    const BatchFolder& folder, const std::vector<const BatchTask*>& open, std::size_t all,
    const BatchLimits& limits,
    const std::function<void(const BatchTask&, const TaskOutcome&, const BatchProgress&)>& report);

}  // namespace polemcl::apps
