#pragma once
/// \file CandidateFeatures.h
/// \brief What the scan says for and against a candidate: rows that hit it, pass through, stand in
/// the way.

#include <algorithm>
#include <cmath>

#include "core/extraction/scan_line/GroundGrid.h"
#include "core/extraction/scan_line/PoleFitting.h"
#include "core/extraction/scan_line/SegmentClustering.h"

namespace polemcl {

/// \brief Shape of a cluster, from its segments alone.
struct ClusterShape {
  int points = 0;           ///< returns in the segments
  int wholeSegments = 0;    ///< segments with both sides free
  float low = 0, high = 0;  ///< of the segments, lidar frame, m
  float scatter =
      0;  ///< rms distance of the segments' middles from a straight line, m; 0 for two segments
  float tilt = 0;         ///< of that line against an upright pole, rad
  float widthSpread = 0;  ///< standard deviation of the segments' widths, m
};
/// \param upright Shift of an upright pole along x and y per unit of height, LiDAR frame.
ClusterShape measureShape(const std::vector<ScanLineSegment>& segments,
                          const SegmentCluster& cluster,
                          const Eigen::Vector2f& upright = Eigen::Vector2f::Zero());

/// \brief What the beams at a candidate's place say. Heights in m above local ground.
struct CandidateFeatures {
  int rowsPassed = 0;  ///< rows between bottom and top that saw through it (or nothing)
  int rowsWide = 0;    ///< rows between bottom and top that met something there that is no segment
  float bottom = 0;    ///< lowest segment
  float top = 0;       ///< highest return, whatever stands on it (sign, crown) included
  float topBound = 0;  ///< height of the lowest beam that passed over it; infinity when none did
  /// \brief How high the top may be, as it lies between the highest return and that beam.
  double highestTop() const {
    const double between = std::isfinite(topBound) ? 0.5 * (top + topBound) : 1e9;
    return std::max<double>(between, top);
  }
};
/// \param minTop m: where the top is lower for certain, the rows below are not looked at.
CandidateFeatures computeFeatures(const ScanLines& lines, const SensorModel& sensor,
                                  const GroundGrid& ground,
                                  const std::vector<ScanLineSegment>& segments,
                                  const SegmentCluster& cluster, const ClusterShape& shape,
                                  const PoleAxis& axis, double minTop = -1e3);

/// \brief Share of the cluster's rows with other returns in a ring around the place, 0.15 to 0.55 m
/// outside the radius: free space, as a score.
float clutteredShare(const ScanLines& lines, const SensorModel& sensor,
                     const std::vector<ScanLineSegment>& segments, const SegmentCluster& cluster,
                     const PoleAxis& axis);

}  // namespace polemcl
