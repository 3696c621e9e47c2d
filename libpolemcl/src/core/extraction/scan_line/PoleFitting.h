#pragma once
/// \file PoleFitting.h
/// \brief Step B3, scan-line method: centre, radius and covariance of a cluster of segments.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/extraction/scan_line/ScanLineSegmenter.h"
#include "core/extraction/scan_line/ScanLines.h"
#include "core/extraction/scan_line/TiltEstimation.h"

namespace polemcl {

/// \brief A vertical cylinder, lidar frame.
struct PoleFit {
  float x = 0, y = 0;  ///< centre, m
  float radius = 0;    ///< m
  float residual = 0;  ///< robust standard deviation of the ranges against the cylinder, m
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< of (x, y), m²
  PoleTilt tilt;
};

/// \brief Where a pole stands, roughly: middle of the segments' fronts, half their width behind.
struct PoleAxis {
  float x = 0, y = 0;  ///< at the height z, lidar frame, m
  float radius = 0;    ///< m
  float z = 0;         ///< mean height of the segments, m
  /// Shift of an upright pole along x and y per unit of height.
  Eigen::Vector2f upright = Eigen::Vector2f::Zero();
};
PoleAxis roughAxis(const std::vector<ScanLineSegment>& segments,
                   const std::vector<std::uint32_t>& used, float columnAngle,
                   const Eigen::Vector2f& upright = Eigen::Vector2f::Zero());

/// \brief How poles are looked at.
struct PoleView {
  float columnAngle = 0;  ///< one firing step, rad
  /// Segments below weigh less, the less the lower, down to 0.5 m below; lidar frame, m.
  float firmHeight = -1e3f;
  /// Shift of an upright pole along x and y per unit of height along z: 0 for an upright lidar.
  float uprightX = 0, uprightY = 0;
};

/// \brief Fits a cylinder by maximum a posteriori: ranges to its front, and the bearings of its
/// edges.
///
/// A circle through the points alone is biased towards the sensor on short arcs (Kåsa 1976; see
/// Al-Sharadqah and Chernov 2009). The silhouette is not: the true edges lie half a firing step,
/// less half the footprint, outside the outermost returns, so the width of the run of returns gives
/// the radius, and ranges plus radius give the centre. Both enter one Gauss-Newton problem in
/// (lateral, depth, radius).
/// The centre is that at the height of the sensor, or as near to it as the segments reach: there a
/// roll or pitch of the sensor does not move it.
/// \param used Which segments to fit (indices into segments), topmost first.
/// \return Nothing when the normal equations are degenerate.
std::optional<PoleFit> fitPole(const ScanLines& lines, const std::vector<ScanLineSegment>& segments,
                               const std::vector<std::uint32_t>& used, const PoleView& view);

}  // namespace polemcl
