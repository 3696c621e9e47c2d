#pragma once
/// \file TrackSampler.h
/// \brief Poses at wanted times from a long track that is read once and never kept.

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace polemcl::io {

/// \brief The pose between two: position linearly, attitude along the shorter turn (slerp).
/// \param share 0 at `a`, 1 at `b`.
Eigen::Isometry3d interpolate(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double share);

/// \brief Is fed samples in the order of their times and keeps the poses at wanted times only: a
/// truth of a million rows costs no more memory than the scans it is for.
class TrackSampler {
 public:
  /// \param times Wanted, s, not falling.
  /// \param maxGap Samples further apart than this are not interpolated across, s.
  TrackSampler(std::vector<double> times, double maxGap);

  /// \brief The next sample. \return False, and it is not used, unless it is after the one before.
  bool add(double time, const Eigen::Isometry3d& pose);

  /// \brief The pose at each wanted time, once all samples are in: a sample within
  /// `sampleTolerance`, else interpolated; none outside the track and in gaps.
  const std::vector<std::optional<Eigen::Isometry3d>>& poses() const { return m_poses; }
  /// \brief How many wanted times have a pose.
  std::size_t found() const;
  /// \brief "12.5 ... 99.25 s" of the samples, or "none", for messages.
  std::string span() const;

 private:
  std::vector<double> m_times;
  double m_maxGap;
  std::vector<std::optional<Eigen::Isometry3d>> m_poses;
  std::size_t m_next = 0;     ///< first wanted time that is still open
  std::size_t m_samples = 0;  ///< used so far
  double m_firstTime = 0, m_lastTime = 0;
  Eigen::Isometry3d m_lastPose = Eigen::Isometry3d::Identity();
};

}  // namespace polemcl::io
