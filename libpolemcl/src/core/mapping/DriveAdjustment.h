#pragma once
/// \file DriveAdjustment.h
/// \brief Joint adjustment of drives and poles to a map whose poles err by metres. Private to the
/// library.
///
/// The LiDAR and the odometry tell where the poles stand to each other; the map, an inventory of a
/// city say, tells where they stand on Earth, each with an error of its own. JointAdjustment holds
/// both together. Pairs are formed anew in each of several rounds; those that do not fit let go,
/// such as poles that do not exist.

#include <vector>

#include "core/mapping/JointAdjustment.h"
#include "core/mapping/MapUpdater.h"

namespace polemcl {

/// \brief What an adjustment may use.
struct DriveAdjustmentOptions {
  PoleMapOptions mapping;  ///< makes the poles of the drives
  AdjustmentTrust trust;
};

struct AdjustedDrives {
  std::vector<Pose2D> poses_map_robot;  ///< one a scan
  std::size_t poles = 0;                ///< seen by the drives
  std::vector<std::size_t> anchors;     ///< poles of the map that are among these
  double anchorDistance = 0;            ///< between the two places of an anchor, rms, m
  /// Standard deviation of the poses along an axis, rms, m: mostly what the map leaves open.
  double sigma = 0;
};

/// \brief Adjusts drives to the poles of a map; their covariances say how much each is worth.
/// \throws Error as buildPoleMap(); when fewer than three poles of the map are found.
AdjustedDrives adjustDrives(const std::vector<DrivenScan>& scans, const std::vector<MapPole>& map,
                            const DriveAdjustmentOptions& options);

}  // namespace polemcl
