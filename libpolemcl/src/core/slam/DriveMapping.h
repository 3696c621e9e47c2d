#pragma once
/// \file DriveMapping.h
/// \brief The poses of drives from their odometry and the poles they saw: simultaneous localization
/// and mapping. Private to the library.
///
/// Poles are followed from scan to scan, which corrects the odometry; submaps are searched among
/// the poles seen earlier (LoopSearch); all is adjusted together (JointAdjustment), and repeated
/// with what is known by then. The frame is that of the first scan.

#include <vector>

#include "core/mapping/JointAdjustment.h"

namespace polemcl {

/// \brief Two scans at the same place, which the drive passed twice.
struct ClosedLoop {
  std::size_t first = 0, second = 0;
};

struct MappedDrives {
  std::vector<PoseWithCovariance> poses;  ///< one a scan; the covariance is against the first
  std::vector<Eigen::Vector2d> odometry;  ///< scale error and yaw bias (rad/m) of each drive
  std::vector<ClosedLoop> loops;
  std::size_t tracks = 0;  ///< poles seen in three scans or more, once for each time passed
  double driven = 0;       ///< m
};

/// \brief Finds the poses. The poses given are not used.
/// \throws Error when fewer than two poles are followed.
MappedDrives mapDrives(std::vector<DrivenScan> scans, const AdjustmentTrust& trust);

}  // namespace polemcl
