#pragma once
/// \file MotionCheck.h
/// \brief Do the poses of a drive agree with how its poles move from scan to scan? No map, no
/// filter.

#include <string>
#include <vector>

#include "core/localization/ScanRegistration.h"
#include "core/mapping/MapUpdater.h"

namespace polemcl {

/// \brief The motion between two scans as their poles have it, near the true one or, where that
/// fits few poles, farther off. Fewer than 3 pairs: the poles do not tell.
ScanRegistration motionOfPoles(const std::vector<PoleDetection>& before,
                               const std::vector<PoleDetection>& after, const Pose2D& truth);

/// \brief Sums up the stretches of a drive.
class MotionCheck {
 public:
  /// \param poles From motionOfPoles(). \param truth The same motion by the poses.
  void add(const ScanRegistration& poles, const Pose2D& truth);

  std::size_t told() const { return m_told; }  ///< stretches of which the poles tell
  /// \brief How many of them contradict the poses: beyond chance (0.1 %), if the poses err by 2 cm
  /// and 0.1°.
  std::size_t contradicting() const { return m_contradicting; }
  /// \brief Most stretches contradict the poses.
  bool contradicts() const { return 2 * m_contradicting > m_told; }
  /// \brief A line for people.
  std::string verdict() const;

 private:
  std::size_t m_told = 0, m_contradicting = 0;
};

/// \brief Each fourth scan with the fourth after it.
MotionCheck checkMotion(const std::vector<SessionScan>& scans);

}  // namespace polemcl
