#pragma once
/// \file LocalizeReport.h
/// \brief What `pole-localize` writes and prints about its runs.

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include <polemcl/mrpt/rawlog/PoleSequence.h>
#include "localize/LocalizeApp.h"

namespace polemcl::apps {

/// \brief Everything the summary tells, gathered by localize().
struct LocalizeFacts {
  LocalizeJob job;
  LocalizationOptions localization;
  StartOptions start;
  std::string startSource;  ///< `truth`, `configuration`, `command line` or `anywhere`
  RunOptions runs;
  SequenceCounts counts;
  std::size_t mapPoles = 0;
};

/// \brief `run_00` for run 0; two digits or more.
std::string runName(std::size_t run);

/// \brief See LocalizeApp.h for the layout.
nlohmann::ordered_json makeSummary(const LocalizeFacts& facts, const LocalizeResult& result);

/// \brief A row per run, mean and spread; without truth the counts alone.
void printTable(std::ostream& out, const LocalizeFacts& facts, const LocalizeResult& result);

}  // namespace polemcl::apps
