#pragma once
/// \file WholeSteps.h
/// \brief Speeds from the stamps of scans, some of which may be too close together.

#include <optional>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>

namespace polemcl {

/// \brief A motion (m, rad; in the robot frame at its begin) and the time that it took.
struct TimedMotion {
  Pose2D motion;
  double seconds = 0;
};

/// \brief Joins the motions between scans to steps that tell a speed.
///
/// After a stall of a bus or a network, two scans have nearly the same stamp, and a motion between
/// them that no vehicle makes in that time. Such a step is joined with the next one, two at most.
class POLEMCL_EXPORT WholeSteps {
 public:
  /// \brief Least length of a step, as a share of the one before.
  static constexpr double leastShare = 0.4;
  /// \brief Greatest speed that is believed, m/s.
  static constexpr double fastest = 70;

  /// \brief One motion more. \param seconds Its time, > 0.
  /// \return The step that it ends; nullopt where that tells no speed.
  std::optional<TimedMotion> add(const Pose2D& motion, double seconds);
  /// \brief The step that a motion would end. Changes nothing.
  TimedMotion joined(const Pose2D& motion, double seconds) const;
  /// \brief Whether a step is long enough, and not too fast.
  bool tellsSpeed(const TimedMotion& step) const;
  /// \brief The next motion begins a step.
  void beginStep();

 private:
  TimedMotion m_rest;    ///< motions that tell no speed yet
  int m_restCount = 0;   ///< of these motions
  double m_usual = 0.1;  ///< length of a step, s; at first that of most LiDARs
};

}  // namespace polemcl
