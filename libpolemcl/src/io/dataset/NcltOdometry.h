#pragma once
/// \file NcltOdometry.h
/// \brief The odometry of NCLT: where the body went, and how far that may be off.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/data/PlanarMotion.h"
#include "io/data/TrackSampler.h"
#include "io/file/ReadProgress.h"

namespace polemcl::io {

/// \brief A pose from x y z roll pitch heading as NCLT writes them: m, rad, Rz·Ry·Rx.
/// \param values Six numbers from here on.
Eigen::Isometry3d ncltPose(const double* values);

/// \brief The files of one session; empty paths are not there.
struct NcltOdometryFiles {
  std::filesystem::path track;        ///< odometry_mu_100hz.csv: utime, pose since the start
  std::filesystem::path steps;        ///< odometry_mu.csv: utime, motion since the row before
  std::filesystem::path covariances;  ///< odometry_cov.csv: utime, 21 numbers, upper triangle
};

/// \brief Odometry between any two times of a session.
///
/// The means come from the track, or without it from the steps joined together; the covariances
/// from those of the steps between, composed; a step that is only partly between counts in
/// proportion. A covariance belongs to the step of its time, or of the nearest time within half a
/// step: the two files need not go row by row. Frame: the body, x ahead, y right, z down.
class NcltOdometry {
 public:
  /// \param times At which the body's pose is wanted, s, not falling.
  /// \param notes Gets a line when covariances are missing or of other times, or rows are out of
  ///        order.
  /// \throws Error naming file and line: cannot be read, short rows, not a number.
  NcltOdometry(const NcltOdometryFiles& files, std::vector<double> times,
               std::vector<std::string>& notes, const ReadProgress& progress = {});

  /// \brief The body in the odometry frame at the wanted times; none outside the track.
  const TrackSampler& track() const { return m_track; }

  /// \brief The motion between two times as a robot sees it that carries the body's frame at
  /// `T_robot_body`. Without covariances in the dataset the standard deviations are 5 % of each
  /// component. At least those of a vehicle that stands (motionFloorMetres) are added.
  /// \param T_begin_end The body's motion from the track. \param begin,end s.
  PlanarMotion motion(const Eigen::Isometry3d& T_begin_end, double begin, double end,
                      const Eigen::Isometry3d& T_robot_body) const;

 private:
  /// A row of the steps with its covariance, in the plane of the body (z down).
  struct Step {
    double begin = 0, end = 0;  ///< s
    PlanarMotion motion;
  };
  void readTrack(const std::filesystem::path& file, std::vector<std::string>& notes,
                 const ReadProgress& progress);
  void readSteps(const NcltOdometryFiles& files, std::vector<std::string>& notes,
                 const ReadProgress& progress);
  std::optional<Eigen::Matrix3d> covarianceBetween(double begin, double end) const;

  TrackSampler m_track;
  std::vector<Step> m_steps;
};

}  // namespace polemcl::io
