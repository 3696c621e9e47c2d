#pragma once
/// \file PoseModes.h
/// \brief Modes of the particles: the heaviest of the places where they are.

#include <vector>

#include "core/common/PoseEstimate.h"

namespace polemcl {

/// \brief Places are cells of the plane and of headings that touch: a wide cloud is one place, two
/// clouds with empty cells between them are two.
constexpr double modeCell = 2;             ///< m
constexpr double modeCellYaw = M_PI / 12;  ///< rad (15°)

struct PoseMode {
  /// Mean of the particles of the heaviest place. The covariance is that of *all* particles about
  /// it: particles elsewhere make this place less certain.
  PoseWithCovariance estimate;
  double share = 1;  ///< of the weight, in the heaviest place
};

/// \brief The heaviest place. Ties: the place of the particle with the lowest index.
/// \param particles, logWeights As for weightedMean(). \throws Error as weightedMean().
PoseMode heaviestMode(const std::vector<Pose2D>& particles, const std::vector<double>& logWeights);

}  // namespace polemcl
