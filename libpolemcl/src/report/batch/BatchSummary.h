#pragma once
/// \file BatchSummary.h
/// \brief Means and spreads over the runs of a session and over the sessions of a configuration.

#include <vector>

#include "report/batch/BatchResults.h"

namespace polemcl::report {

/// \brief Mean and standard deviation of a sample.
struct Spread {
  double mean = noFigure;       ///< none without values
  double deviation = noFigure;  ///< of the sample (n - 1); none with less than two values
  double largest = noFigure;
  std::size_t count = 0;
};
/// \brief Spread of the finite values.
Spread spreadOf(const std::vector<double>& values);

enum class RunState { ok, lost, failed };
/// \brief "ok", "lost", "failed".
const char* name(RunState state);
/// \brief failed: it has no result. lost: see BatchResults::lostBound.
RunState stateOf(const BatchRun& run, double lostBound);

/// \brief How many runs there are, and in which state.
struct RunCounts {
  std::size_t runs = 0, lost = 0, failed = 0;
};

/// \brief Figures that are summed up; lost runs with a pose count in all of them.
struct MetricSpreads {
  Spread posMean, posRmse, posMax, posEnd, latMean, latStd, lonMean, lonStd, xRmse, yRmse;
  Spread axisRmse;  ///< root of the mean of x² and y²: the position RMSE per axis, posRmse / √2
  Spread angMeanDeg, angStdDeg, angRmseDeg;
  Spread ok, degraded, lost;  ///< shares of scans
};

/// \brief A session under a configuration, over its runs.
struct SessionSummary {
  std::size_t session = 0;  ///< index in the batch
  double mapShare = noFigure;
  std::size_t mapPoles = 0;
  RunCounts counts;
  MetricSpreads figures;
  double relocalizations = noFigure;  ///< mean over the runs
};

/// \brief Means over maps, each with the same weight.
struct ScoreMeans {
  double precision = noFigure, recall = noFigure, f1 = noFigure;
};
/// \brief The scored maps of a configuration; see MapScores.
struct ScoreSummary {
  std::size_t maps = 0;
  ScoreMeans near, oneToOne, oneToOneHalf;
};

/// \brief A configuration over its sessions.
struct ConfigurationSummary {
  std::vector<SessionSummary> sessions;  ///< in the order of the batch; those with a result
  RunCounts counts;
  std::size_t localized = 0;     ///< sessions with at least one run that has figures
  std::size_t lostSessions = 0;  ///< sessions with runs, all of which were lost or failed
  /// Over the sessions' means: every session has the same weight, as in the paper. `largest` is
  /// that of all runs.
  MetricSpreads figures;
  Spread mapShare;  ///< over the localized sessions, as the errors; over all if there are none
  ScoreSummary scores;
  /// posMean of the last localized session over that of the first; none with less than two.
  double lastOverFirst = noFigure;
};

/// \brief One for each configuration, in the order of the batch.
using Summaries = std::vector<ConfigurationSummary>;
Summaries summarize(const BatchResults& results);

}  // namespace polemcl::report
