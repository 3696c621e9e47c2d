#pragma once
/// \file LandmarkFusion.h
/// \brief Detections at a known pose -> observations in the map frame; several of one pole -> one
/// pole.

#include <string>
#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief One detection in the map frame.
struct LandmarkObservation {
  PoleDetection pole;      ///< x, y and covariance in the map frame, the scan's pose error included
  std::uint32_t scan = 0;  ///< number of the scan; a pole has at most one observation of each
};

/// \brief Centre of the observations: mean by inverse covariance times confidence, without
/// outliers.
///
/// Observations beyond the 99 % ellipse of their covariance are left out, starting from the median.
/// All ellipses are widened where the scatter is larger than the covariances say.
/// \param members Indices into `observations`, at least one.
/// \param covariance If given: covariance of the mean, also widened by the scatter; m².
/// \param inliers If given: the members that were not left out, in the order of `members`.
Eigen::Vector2d fusedCentre(const std::vector<LandmarkObservation>& observations,
                            const std::vector<std::uint32_t>& members,
                            Eigen::Matrix2d* covariance = nullptr,
                            std::vector<std::uint32_t>* inliers = nullptr);

/// \brief The pole: fused centre and covariance; radius the mean over the same observations; bottom
/// and top the 10 % and 90 % quantiles, because rare extremes are branches or hidden feet;
/// confidence the mean; count the number of observations.
MapPole fuse(const std::vector<LandmarkObservation>& observations,
             const std::vector<std::uint32_t>& members);

/// \brief How far poses of scans can be trusted.
struct PoseTrust {
  double sigma = 0;         ///< of the position, m
  double headingSigma = 0;  ///< rad
  /// Covariance of this pose beyond that: x, y, yaw; m², m·rad, rad².
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// \brief A detection in the map frame, made less certain by what the scan's pose is not known to.
/// \param pole Robot frame. \param pose Robot in the map frame. \param scan Number of the scan.
LandmarkObservation landmarkObservation(const PoleDetection& pole, const Pose2D& pose,
                                        std::uint32_t scan, const PoseTrust& trust);

/// \throws Error on a pose or detection that is not finite, a confidence outside [0, 1], or a
///         covariance that is not symmetric positive semidefinite, naming the detection.
/// \param where Names the scan, e.g. "scan 12".
void checkScan(const Pose2D& pose, const std::vector<PoleDetection>& poles,
               const std::string& where);

}  // namespace polemcl
