#pragma once
/// \file PoseModes.h
/// \brief Are the particles in one place or in several? The heaviest of the places they are in.

#include <vector>

#include <polemcl/core/common/PoseEstimate.h>

namespace polemcl {

/// \brief Places are cells of the plane and of headings that touch: a wide cloud is one place, two
/// clouds with empty cells between them are two.
constexpr double modeCell = 2;             ///< m
constexpr double modeCellYaw = M_PI / 12;  ///< rad (15°)

struct PoseMode {
  /// Mean of the heaviest place's particles. The covariance is that of *all* particles about it:
  /// what speaks for another place makes this one less certain.
  PoseWithCovariance estimate;
  double share = 1;  ///< of the weight, in the heaviest place
};

/// \brief The heaviest place; of equals, the one of the particle with the lowest index.
/// \param particles, logWeights As for weightedMean(). \throws Error as weightedMean().
PoseMode heaviestMode(const std::vector<Pose2D>& particles, const std::vector<double>& logWeights);

}  // namespace polemcl
