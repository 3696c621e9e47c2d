#pragma once
/// \file LocalizeReport.h
/// \brief What `pole-localize` writes and prints about its runs.

#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <utility>

#include "io/map/Datum.h"
#include "localize/LocalizeApp.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl::apps {

/// \brief Everything the summary tells, gathered by localize().
struct LocalizeFacts {
  LocalizeJob job;
  SettingsValues settings;
  std::string startSource;  ///< `truth`, `configuration`, `command line`, `gnss` or `anywhere`
  SequenceCounts counts;
  std::size_t mapPoles = 0;
  std::optional<io::Datum> datum;  ///< of the map, where a position from satellites gives the start
};

/// \brief The errors of a trajectory by their names in JSON: m and degrees.
inline constexpr std::pair<const char*, double TrajectoryErrors::*> trajectoryMetrics[] = {
    {"pos_mean", &TrajectoryErrors::posMean},
    {"pos_rmse", &TrajectoryErrors::posRmse},
    {"lat_mean", &TrajectoryErrors::latMean},
    {"lon_mean", &TrajectoryErrors::lonMean},
    {"ang_mean_deg", &TrajectoryErrors::angMeanDeg},
    {"ang_rmse_deg", &TrajectoryErrors::angRmseDeg},
    {"pos_max", &TrajectoryErrors::posMax}};
/// \brief All of these, and the numbers of poses with and without truth.
nlohmann::ordered_json errorsJson(const TrajectoryErrors& errors);

/// \brief `run_00` for run 0; two digits or more.
std::string runName(std::size_t run);

/// \brief See LocalizeApp.h for the layout.
nlohmann::ordered_json makeSummary(const LocalizeFacts& facts, const LocalizeResult& result);

/// \brief A row per run, mean and spread; without truth the counts alone.
void printTable(std::ostream& out, const LocalizeFacts& facts, const LocalizeResult& result);

}  // namespace polemcl::apps
