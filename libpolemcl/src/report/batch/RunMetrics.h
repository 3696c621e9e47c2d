#pragma once
/// \file RunMetrics.h
/// \brief The figures of a run by name, for everything that goes through all of them.

#include "report/batch/BatchSummary.h"

namespace polemcl::report {

/// \brief A figure of a run and where it is summed up; named as by `pole-eval trajectory`.
struct FigureName {
  const char* key;
  double ErrorFigures::*figure;
  Spread FigureSpreads::*spread;
};
inline constexpr FigureName figureNames[] = {
    {"pos_mean", &ErrorFigures::posMean, &FigureSpreads::posMean},
    {"pos_rmse", &ErrorFigures::posRmse, &FigureSpreads::posRmse},
    {"pos_max", &ErrorFigures::posMax, &FigureSpreads::posMax},
    {"pos_end", &ErrorFigures::posEnd, &FigureSpreads::posEnd},
    {"lat_mean", &ErrorFigures::latMean, &FigureSpreads::latMean},
    {"lat_std", &ErrorFigures::latStd, &FigureSpreads::latStd},
    {"lon_mean", &ErrorFigures::lonMean, &FigureSpreads::lonMean},
    {"lon_std", &ErrorFigures::lonStd, &FigureSpreads::lonStd},
    {"x_rmse", &ErrorFigures::xRmse, &FigureSpreads::xRmse},
    {"y_rmse", &ErrorFigures::yRmse, &FigureSpreads::yRmse},
    {"ang_mean_deg", &ErrorFigures::angMeanDeg, &FigureSpreads::angMeanDeg},
    {"ang_std_deg", &ErrorFigures::angStdDeg, &FigureSpreads::angStdDeg},
    {"ang_rmse_deg", &ErrorFigures::angRmseDeg, &FigureSpreads::angRmseDeg}};

/// \brief A share of scans by health state.
struct ShareName {
  const char* key;
  double HealthShares::*share;
  Spread FigureSpreads::*spread;
};
inline constexpr ShareName shareNames[] = {
    {"ok", &HealthShares::ok, &FigureSpreads::ok},
    {"degraded", &HealthShares::degraded, &FigureSpreads::degraded},
    {"lost", &HealthShares::lost, &FigureSpreads::lost}};

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
double axisRmse(const ErrorFigures& errors);

}  // namespace polemcl::report
