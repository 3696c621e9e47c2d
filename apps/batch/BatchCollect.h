#pragma once
/// \file BatchCollect.h
/// \brief From what a batch left on disk to its results, and from these to the report.

#include <map>
#include <string>
#include <vector>

#include "batch/BatchFolder.h"
#include "batch/BatchPlan.h"
#include "batch/BatchSpec.h"
#include "cli/JsonFile.h"
#include "report/batch/BatchResults.h"

namespace polemcl::apps {

/// \brief Reads the trajectories of all runs that are done and judges them.
/// \param failures Failures of this and earlier attempts, by task. Tasks left open have no figures.
/// \param command Command that makes the batch again.
/// A run that cannot be compared with the truth is a failure of its own.
/// \throws Error when a file of a task that is done cannot be read.
report::BatchResults collectBatch(const BatchFolder& folder, const BatchPlan& plan,
                                  const BatchSpec& spec,
                                  const std::map<std::string, std::string>& failures,
                                  const std::string& command);

/// \brief How long a batch took, the only part of a report that differs from one time to the next:
/// `machine`, and in `tasks` for each `kind` the `seconds` of each task, the last time that it was
/// done. `wall_s`, s from the first task to the last, is `null`, and `jobs` at the same time 0: the
/// caller may know them.
Json collectTimings(const BatchFolder& folder, const BatchPlan& plan);

/// \brief Removes results and report of an earlier state of the batch. \param timings Also
/// `timings.json`.
void removeResults(const BatchFolder& folder, bool timings);

/// \brief Writes `report.html`, `table.tex`, `runs.csv`, `sessions.csv`, `maps.csv`, and, last,
/// `results.json` into the batch's folder, by the script share/report/report.py. Where that cannot
/// work, `results.json` alone, without `summary`. \throws Error then, with the script's last line,
/// which names the packages that it misses; also when a file cannot be written.
void writeBatchFiles(const BatchFolder& folder, const report::BatchResults& results);

}  // namespace polemcl::apps
