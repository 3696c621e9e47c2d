#pragma once
/// \file TrackSampler.h
/// \brief Interpolates poses at given times from a long track that is read once and not stored.

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace polemcl::io {

/// \brief Interpolated pose: linear in position, slerp (shorter rotation) in attitude.
/// \param share 0 at `a`, 1 at `b`.
Eigen::Isometry3d interpolate(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double share);

/// \brief Takes samples in the order of time and keeps only the poses at the requested times.
/// Memory grows with the number of scans, not with the length of the track.
class TrackSampler {
 public:
  /// \param times Requested times, s, in ascending order (equal times are allowed).
  /// \param maxGap Longest gap between two samples that is interpolated, s.
  TrackSampler(std::vector<double> times, double maxGap);

  /// \brief Adds the next sample. \return False if its time is not after the previous one; the
  /// sample is then ignored.
  bool add(double time, const Eigen::Isometry3d& pose);

  /// \brief The pose at each requested time, once all samples are added. A sample within
  /// `sampleTolerance` is used directly; otherwise the pose is interpolated. Times outside the
  /// track or in a gap have no pose.
  const std::vector<std::optional<Eigen::Isometry3d>>& poses() const { return m_poses; }
  /// \brief Number of requested times that have a pose.
  std::size_t found() const;
  /// \brief Time span of the samples for messages, e.g. "12.5 ... 99.25 s"; "none" without samples.
  std::string span() const;

 private:
  std::vector<double> m_times;
  double m_maxGap;
  std::vector<std::optional<Eigen::Isometry3d>> m_poses;
  std::size_t m_next = 0;     ///< first requested time without a result yet
  std::size_t m_samples = 0;  ///< number of samples used so far
  double m_firstTime = 0, m_lastTime = 0;
  Eigen::Isometry3d m_lastPose = Eigen::Isometry3d::Identity();
};

}  // namespace polemcl::io
