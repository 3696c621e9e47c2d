#pragma once
/// \file SessionPoses.h
/// \brief Where a session's scans were taken: by its truth, by the localizer's own estimates, or by
/// its odometry alone.

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "core/common/Deskew.h"

namespace polemcl::apps {

/// \brief Where poses of sessions come from.
enum class PoseKind {
  truth,     ///< a TUM file
  estimate,  ///< a run of `pole-localize`
  odometry   ///< no file: motions one behind the other, for mapDrives() to make better
};

/// \brief The pose of one scan.
struct ScanPose {
  Pose2D pose;                                           ///< of the robot in the map, m and rad
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< x, y, yaw, m and rad; zero for truth
  bool isOk = true;  ///< false: the localizer was `degraded` or `lost` there
};

/// \brief The poses of one session, from one file.
class SessionPoses {
 public:
  /// \param file For truth: TUM, robot poses. For an estimate: `run_NN.tum` of `pole-localize`;
  /// poses and covariances are read from the `run_NN_cov.csv` beside it, its health from
  /// `run_NN_health.csv`.
  /// \throws Error when a file cannot be read.
  SessionPoses(PoseKind kind, const std::filesystem::path& file);
  /// \brief Poses by the odometry, from the first scan on.
  explicit SessionPoses(std::vector<StampedPose2D> odometry);

  /// \brief None where the file says nothing.
  /// \param scan Number of the scan in its rawlog. \param time Time of the scan, s.
  /// \throws Error when an estimate for this scan has another time: it is of another rawlog.
  std::optional<ScanPose> at(std::size_t scan, double time) const;
  /// \brief Velocity in the frame of the robot, from the poses before and after; zero where there
  /// is a gap.
  Velocity velocityAt(double time) const;

 private:
  std::optional<ScanPose> estimateOf(std::size_t scan, double time) const;

  PoseKind m_kind;
  std::filesystem::path m_file;
  std::vector<StampedPose2D> m_trajectory;
  struct Estimate {
    double time = 0;
    ScanPose pose;
  };
  std::map<std::size_t, Estimate> m_estimates;  ///< by the number of the scan
};

}  // namespace polemcl::apps
