#pragma once
/// \file BatchMeasures.h
/// \brief From the trajectories of a run to the figures and curves of a batch's results.

#include <vector>

#include "core/evaluation/TrajectoryEvaluation.h"
#include "report/batch/BatchResults.h"

namespace polemcl::report {

/// \brief All figures of a run.
/// \param errors Result of evaluateTrajectory() against the same truth.
/// \param truth Robot poses, times increasing; gives the axes that lateral and longitudinal errors
///        are turned back into.
ErrorMetrics errorMetrics(const TrajectoryErrors& errors, const std::vector<StampedPose2D>& truth);

/// \brief Adds a run's errors to the histograms of its session.
void addErrors(SessionPlots& plots, const TrajectoryErrors& errors);

/// \brief Some of the points, such that none lies farther than `tolerance` from the line through
/// those (Douglas and Peucker 1973), rounded to centimetres. First and last remain.
/// \param tolerance m; 0 chooses 1/1500 of the larger side of their box.
std::vector<Eigen::Vector2d> thinPath(const std::vector<Eigen::Vector2d>& points,
                                      double tolerance = 0);
/// \brief Thins the positions of a trajectory in the same way.
std::vector<Eigen::Vector2d> thinPath(const std::vector<StampedPose2D>& path, double tolerance = 0);

/// \brief Position errors over the distance driven, the largest of each bin.
/// \param truth See errorMetrics().
/// \param mostBins The bin width is 1, 2 or 5 times a power of ten, at least 1 m and 1.5 times the
///        usual distance between two errors, such that there are not more bins.
BinnedMaxima positionOverDistance(const TrajectoryErrors& errors,
                                  const std::vector<StampedPose2D>& truth,
                                  std::size_t mostBins = 500);

}  // namespace polemcl::report
