#pragma once
/// \file MotionCheck.h
/// \brief Do the poses of a drive agree with how its poles move from scan to scan? No map, no
/// filter.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/localization/ScanRegistration.h"
#include "core/mapping/MapUpdater.h"

namespace polemcl {

/// \brief The motion between two scans as their poles have it, near the true one or, where that
/// fits few poles, farther off: but not where an even row of poles fits both. Fewer than 3 pairs:
/// the poles do not tell.
ScanRegistration motionOfPoles(const std::vector<PoleDetection>& before,
                               const std::vector<PoleDetection>& after, const Pose2D& truth);

/// \brief Sums up the stretches of a drive.
class MotionCheck {
 public:
  /// \param poles From motionOfPoles(). \param truth The same motion by the poses.
  /// \param time Of the scan after the stretch, s.
  /// \param isConfirmed Whether other scans tell the same, where the stretch contradicts clearly.
  void add(const ScanRegistration& poles, const Pose2D& truth, double time,
           bool isConfirmed = true);

  std::size_t told() const { return m_told; }  ///< stretches of which the poles tell
  /// \brief How many of them contradict the poses far beyond chance, see contradictsClearly(), and
  /// are confirmed.
  std::size_t steps() const { return m_steps; }
  /// \brief Most stretches contradict the poses, or one of them clearly does.
  bool contradicts() const { return 2 * m_contradicting > m_told || m_steps > 0; }
  /// \brief A line for people.
  std::string verdict() const;
  /// \brief A line that tells by how much the LiDAR is turned on the vehicle, if stretches by the
  /// poles point to one side of those by the poses; else empty.
  std::string mountingDoubt() const;

 private:
  void addMounting(const ScanRegistration& poles, const Pose2D& truth);

  /// Normal equations of what explains how far, in m, the poles are to the right of the poses: way
  /// in m times the angle by which the LiDAR is turned to the left, and turn in rad times the
  /// distance in m by which it stands farther back.
  struct {
    std::size_t stretches = 0;
    Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
    Eigen::Vector2d vector = Eigen::Vector2d::Zero();
    double square = 0;
  } m_mounting;
  std::size_t m_told = 0, m_steps = 0;
  /// Stretches beyond chance (0.1 %), if the poses err by 2 cm and 0.1°.
  std::size_t m_contradicting = 0;
  double m_worstTime = 0, m_worstMetres = -1;  ///< of the steps, s and m
};

/// \brief A stretch contradicts the poses by 0.3 m or 1.7° at least, beyond chance, by four pairs
/// of poles or more: the poses have a step there.
bool contradictsClearly(const ScanRegistration& poles, const Pose2D& truth);

/// \brief Each fourth scan with the fourth after it. Where these contradict clearly, the scans
/// beside them must tell the same, else it was a wrong pairing of poles. Those with fewer than four
/// pairs tell nothing.
MotionCheck checkMotion(const std::vector<SessionScan>& scans);

}  // namespace polemcl
