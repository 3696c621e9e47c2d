#pragma once
/// \file NcltOdometry.h
/// \brief Odometry of NCLT: motion of the body, with its uncertainty.

#include <filesystem>
#include <string>
#include <vector>

#include "io/data/PlanarMotion.h"
#include "io/data/TrackSampler.h"
#include "io/file/TextFile.h"

namespace polemcl::io {

/// \name Rows of NCLT's tables, for messages
/// @{
inline constexpr const char* kNcltPoseLayout = "utime, x, y, z, roll, pitch, heading (us, m, rad)";
inline constexpr const char* kNcltCovarianceLayout =
    "utime, 21 numbers: the upper triangle of the covariance of x y z roll pitch heading";
/// @}

/// \brief Pose from x y z roll pitch heading as NCLT writes them: m, rad, Rz·Ry·Rx.
/// \param values Pointer to the six numbers.
Eigen::Isometry3d ncltPose(const double* values);

/// \brief The files of one session; a path is empty if the file does not exist.
struct NcltOdometryFiles {
  std::filesystem::path track;        ///< odometry_mu_100hz.csv: utime, pose since the start
  std::filesystem::path steps;        ///< odometry_mu.csv: utime, motion since the previous row
  std::filesystem::path covariances;  ///< odometry_cov.csv: utime, 21 numbers, upper triangle
};

/// \brief Odometry between any two times of a session.
///
/// The means come from the track; without a track, from the accumulated steps. The covariances of
/// the steps in the interval are composed. A step that lies only partly in the interval contributes
/// in proportion. The rows of the two files may not match: a step takes the covariance row with its
/// time, or the nearest row within half a step. Frame: the body, x forward, y right, z down.
class NcltOdometry {
 public:
  /// \param times Times at which the body's pose is needed, s, in ascending order (equal times are
  ///        allowed).
  /// \param notes Gets a line when covariances are missing or have other times, or rows are out of
  ///        order.
  /// \throws Error with file and line: file not readable, short rows, not a number.
  NcltOdometry(const NcltOdometryFiles& files, std::vector<double> times,
               std::vector<std::string>& notes, const ReadProgress& progress = {});

  /// \brief Pose of the body in the odometry frame at the requested times; empty outside the track.
  const TrackSampler& track() const { return m_track; }

  /// \brief The motion between two times for a robot frame in which the body frame has the pose
  /// `T_robot_body`. If the dataset has no covariances, the standard deviations are 5 % of each
  /// component. The variances of motionFloorMetres and motionFloorRadians are added.
  /// \param T_begin_end Motion of the body from the track. \param begin,end s.
  PoseWithCovariance motion(const Eigen::Isometry3d& T_begin_end, double begin, double end,
                            const Eigen::Isometry3d& T_robot_body) const;

 private:
  void readTrack(const std::filesystem::path& file, std::vector<std::string>& notes,
                 const ReadProgress& progress);
  void readSteps(const NcltOdometryFiles& files, std::vector<std::string>& notes,
                 const ReadProgress& progress);

  TrackSampler m_track;
  MotionSteps m_steps;  ///< rows of the steps with covariances, in the plane of the body (z down)
};

}  // namespace polemcl::io
