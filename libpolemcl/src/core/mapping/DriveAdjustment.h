#pragma once
/// \file DriveAdjustment.h
/// \brief Joint adjustment of drives and poles to a map whose poles err by metres. Private to the
/// library.
///
/// The LiDAR and the odometry tell where the poles stand to each other; the map, an inventory of a
/// city say, tells where they stand on Earth, each with an error of its own. One least-squares
/// problem (Dellaert and Kaess 2006) holds all poses, the places of the poles seen, and scale error
/// and yaw bias of each drive's odometry. Pairs are formed anew in each of several rounds; Geman
/// and McClure's weights let go of pairs that do not fit, such as poles that do not exist.

#include <optional>
#include <vector>

#include "core/common/PoseEstimate.h"
#include "core/mapping/MapUpdater.h"

namespace polemcl {

/// \brief One scan of a drive.
struct DrivenScan {
  Pose2D pose_map_robot;                     ///< where to start from, within decimetres
  std::vector<PoleDetection> poles_robot;    ///< seen from one place: deskewed
  std::optional<PoseWithCovariance> motion;  ///< since the scan before; none: another drive begins
};

/// \brief What an adjustment may use.
struct DriveAdjustmentOptions {
  PoleMapOptions mapping;     ///< makes the poles of the drives
  double scaleSigma = 0.02;   ///< standard deviation of the scale error of an odometry, as a share
  double yawSigma = 0.00052;  ///< of its yaw bias, rad per metre driven forwards
  double decorrelation = 5;   ///< scans within this distance count as one, m
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
