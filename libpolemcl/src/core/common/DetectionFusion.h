#pragma once
/// \file DetectionFusion.h
/// \brief Detections of several LiDARs on one vehicle -> each pole once.

#include <cstddef>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "core/common/Deskew.h"

namespace polemcl {

/// \brief How well two LiDARs agree on the poles that both see. Sums: add to combine.
struct FusionAgreement {
  std::size_t poles = 0;     ///< seen by both
  double squaredMetres = 0;  ///< sum of the squared distances between the two places, m²
  double squaredSigmas = 0;  ///< the same as multiples of their covariances; 2 a pole is expected
  void operator+=(const FusionAgreement& other);
};

/// \brief Greatest distance between the places of one pole as two LiDARs see it, m. One LiDAR
/// reports no two poles that are nearer to each other (ScanLineOptions::minSpacing).
constexpr double samePoleRadius = 0.4;

/// \brief Adds the detections of one more LiDAR. Those that lie, at one moment, within
/// samePoleRadius of a detection that is there already are the same pole, the closest pairs first.
///
/// A pole seen twice becomes one detection: the mean by inverse covariance, at the mean of the two
/// times by the same weights, so that an error of the velocity has no effect in the first order.
/// Errors of the two are taken as independent; where they disagree beyond the 95 % ellipse, the
/// covariance is widened by as much. Radius: by the same weights. It reaches from the lower bottom
/// to the higher top, has the greater confidence and the sum of the points.
/// \param fused Robot frame at the moment each was measured, `timeOffset` from one common stamp.
/// \param more In the same way, of one LiDAR.
/// \param velocity The velocity of the robot at the stamp.
/// \return How well `more` agrees with `fused`.
FusionAgreement fuseDetections(std::vector<PoleDetection>& fused,
                               const std::vector<PoleDetection>& more, const Velocity& velocity);

}  // namespace polemcl
