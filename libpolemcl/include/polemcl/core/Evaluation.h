#pragma once
/// \file Evaluation.h
/// \brief Trajectory errors, and precision / recall / F1 of pole maps, in the authors' ways.

#include <polemcl/core/Types.h>

#include <Eigen/Core>
#include <vector>

namespace polemcl {

struct StampedPose2D {
  double time = 0;  ///< s
  Pose2D pose;
};

struct PoseError {
  double time = 0;
  double position = 0;      ///< Euclidean in the plane, m
  double lateral = 0;       ///< signed, + left of the true heading, m
  double longitudinal = 0;  ///< signed, + ahead, m
  double heading = 0;       ///< signed, rad, wrapped
};

/// \brief Summary over poses. lat/lon/ang means are of absolute values.
struct TrajectoryErrors {
  double posMean = 0, posRmse = 0, posMax = 0;
  double latMean = 0, lonMean = 0;
  double angMeanDeg = 0, angRmseDeg = 0;
  std::size_t poses = 0;      ///< compared
  std::size_t unmatched = 0;  ///< estimates outside the time span of the truth, or in a gap of it
  std::vector<PoseError> errors;
};

enum class Sampling { perPose, perMetre };  ///< perMetre: every 1 m along the true path (NCLT protocol)

/// \brief Compares in 2D, convergence included; truth is interpolated in time.
/// \param maxTruthGap Truth samples further apart than this are not interpolated across, s.
/// \throws Error when less than half of the estimates can be matched, or times are not increasing.
TrajectoryErrors evaluateTrajectory(const std::vector<StampedPose2D>& truth,
                                    const std::vector<StampedPose2D>& estimate, Sampling sampling,
                                    double maxTruthGap = 2.0);

struct MapScore {
  std::size_t mapPoles = 0, truthPoles = 0, matches = 0;
  double precision = 0, recall = 0, f1 = 0;
};
/// \brief Matches map poles to truth poles within `radius` (inclusive), m.
/// \param oneToOne false: TP = map poles whose nearest truth pole lies within the radius, for both
///        figures (the authors' way; recall can exceed 1). true: maximum bipartite matching.
/// \throws Error when either set is empty.
MapScore scoreMap(const std::vector<Eigen::Vector2d>& truth, const std::vector<Eigen::Vector2d>& map,
                  double radius, bool oneToOne);

}  // namespace polemcl
