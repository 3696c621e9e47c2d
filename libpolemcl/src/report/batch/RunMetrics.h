#pragma once
/// \file RunMetrics.h
/// \brief The figures of a run by name, for everything that goes through all of them.

#include "report/batch/BatchSummary.h"

namespace polemcl::report {

/// \brief A figure of a run and where it is summed up; named as by `pole-eval trajectory`.
struct MetricName {
  const char* key;
  double ErrorMetrics::*figure;
  Spread MetricSpreads::*spread;
};
inline constexpr MetricName metricNames[] = {
    {"pos_mean", &ErrorMetrics::posMean, &MetricSpreads::posMean},
    {"pos_rmse", &ErrorMetrics::posRmse, &MetricSpreads::posRmse},
    {"pos_max", &ErrorMetrics::posMax, &MetricSpreads::posMax},
    {"pos_end", &ErrorMetrics::posEnd, &MetricSpreads::posEnd},
    {"lat_mean", &ErrorMetrics::latMean, &MetricSpreads::latMean},
    {"lat_std", &ErrorMetrics::latStd, &MetricSpreads::latStd},
    {"lon_mean", &ErrorMetrics::lonMean, &MetricSpreads::lonMean},
    {"lon_std", &ErrorMetrics::lonStd, &MetricSpreads::lonStd},
    {"x_rmse", &ErrorMetrics::xRmse, &MetricSpreads::xRmse},
    {"y_rmse", &ErrorMetrics::yRmse, &MetricSpreads::yRmse},
    {"ang_mean_deg", &ErrorMetrics::angMeanDeg, &MetricSpreads::angMeanDeg},
    {"ang_std_deg", &ErrorMetrics::angStdDeg, &MetricSpreads::angStdDeg},
    {"ang_rmse_deg", &ErrorMetrics::angRmseDeg, &MetricSpreads::angRmseDeg}};

/// \brief A share of scans by health state.
struct ShareName {
  const char* key;
  double HealthShares::*share;
  Spread MetricSpreads::*spread;
};
inline constexpr ShareName shareNames[] = {
    {"ok", &HealthShares::ok, &MetricSpreads::ok},
    {"degraded", &HealthShares::degraded, &MetricSpreads::degraded},
    {"lost", &HealthShares::lost, &MetricSpreads::lost}};

/// \brief A way to count the score of a map.
struct ScoreName {
  const char* key;
  MapScore MapScores::*score;
  ScoreMeans ScoreSummary::*means;
};
inline constexpr ScoreName scoreNames[] = {
    {"near_1m", &MapScores::near, &ScoreSummary::near},
    {"one_to_one_1m", &MapScores::oneToOne, &ScoreSummary::oneToOne},
    {"one_to_one_0.5m", &MapScores::oneToOneHalf, &ScoreSummary::oneToOneHalf}};

/// \brief The position RMSE per axis, as MulRan's published figures give it, m.
double axisRmse(const ErrorMetrics& errors);

}  // namespace polemcl::report
