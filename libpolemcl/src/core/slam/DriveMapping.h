#pragma once
/// \file DriveMapping.h
/// \brief The poses of drives from their odometry and the poles they saw: simultaneous localization
/// and mapping. Private to the library.
///
/// Poles are followed from scan to scan, which corrects the odometry; submaps are searched among
/// the poles seen earlier (LoopSearch), which closes loops and connects drives; all is adjusted
/// together (JointAdjustment), and repeated with what is known by then. The frame is that of the
/// poses that are known, or that of positions from satellites, else that of the first scan.

#include <string>
#include <vector>

#include "core/mapping/JointAdjustment.h"
#include "core/slam/DriveFixes.h"

namespace polemcl {

/// \brief Two scans at the same place, which the drive passed twice.
struct ClosedLoop {
  std::size_t first = 0, second = 0;
};

struct DrivesToMap {
  std::vector<DrivenScan> scans;
  std::vector<std::string> names;  ///< of the drives, for messages
  /// The first `known` scans are all of the first drives; their poses stay. Of a later drive only
  /// the pose of its first scan is read: where it begins.
  std::size_t known = 0;
  /// Covariances of the known poses, relative to the first one. Zero for a true pose; empty if all
  /// are true.
  std::vector<Eigen::Matrix3d> knownCovariances;
  /// By scans. They are on the plane of the map, whose frame is that of the poses found then.
  std::vector<DriveFix> fixes;
};

struct MappedDrives {
  std::vector<PoseWithCovariance> poses;  ///< one a scan; the covariance is against the first
  std::size_t known = 0;                  ///< number of poses at the begin that were known
  std::vector<Eigen::Vector2d> odometry;  ///< scale error and yaw bias (rad/m) of each other drive
  std::vector<ClosedLoop> loops;          ///< those between known scans, too
  std::size_t tracks = 0;  ///< poles seen in three scans or more, once for each time passed
  /// How the positions from satellites fit, of each other drive. None given: the frame is not
  /// theirs.
  std::vector<FixFit> fixes;
  double driven = 0;  ///< by the drives whose poses were not known, m
  /// \brief Number of loops that drives whose poses were not known closed.
  std::size_t newLoops() const;
};

/// \brief Finds the poses.
/// \throws Error when fewer than two poles are followed, or a drive shares no place with the
/// others.
MappedDrives mapDrives(DrivesToMap drives, const AdjustmentTrust& trust);

}  // namespace polemcl
