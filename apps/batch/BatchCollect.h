#pragma once
/// \file BatchCollect.h
/// \brief From what a batch left on disk to its results, and from these to the report.

#include <map>
#include <string>

#include "batch/BatchFolder.h"
#include "batch/BatchPlan.h"
#include "batch/BatchSpec.h"
#include "report/batch/BatchResults.h"

namespace polemcl::apps {

/// \brief Reads the trajectories of all runs that are done and judges them.
/// \param failures Failures of this and earlier attempts, by task. Tasks left open have no figures.
/// \param command Command that makes the batch again.
/// \throws Error when a file of a task that is done cannot be read.
report::BatchResults collectBatch(const BatchFolder& folder, const BatchPlan& plan,
                                  const BatchSpec& spec,
                                  const std::map<std::string, std::string>& failures,
                                  const std::string& command);

/// \brief How long the tasks took, each the last time that it was done.
report::BatchTimings collectTimings(const BatchFolder& folder, const BatchPlan& plan);

/// \brief Writes `report.html`, `results.json`, `runs.csv`, `sessions.csv`, `maps.csv`, `table.tex`
/// into the batch's folder. \throws Error when one cannot be written.
void writeBatchFiles(const BatchFolder& folder, const report::BatchResults& results,
                     const report::BatchTimings& timings);

}  // namespace polemcl::apps
