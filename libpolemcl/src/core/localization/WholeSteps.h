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
/// After a stall of a bus or a network, scans come in a burst and are stamped when they come. The
/// first has a motion too short for its time, and the others motions that no vehicle makes in
/// theirs. Such motions are joined with those after them, until one is as long as usual, or they
/// are so together.
class POLEMCL_EXPORT WholeSteps {
 public:
  /// \brief Least length of a step, as a share of the usual one.
  static constexpr double leastShare = 0.4;
  /// \brief Greatest speed that is believed, m/s.
  static constexpr double fastest = 70;

  /// \brief One motion more. \param seconds Its time, > 0.
  /// \return The step that it ends; nullopt where that tells no speed.
  std::optional<TimedMotion> add(const Pose2D& motion, double seconds);
  /// \brief The step that a motion would end. Changes nothing.
  TimedMotion joined(const Pose2D& motion, double seconds) const;
  /// \brief Whether a motion tells no speed yet: its stamp may be wrong. Changes nothing.
  bool isOpen(const Pose2D& motion, double seconds) const;
  /// \brief Whether a step is long enough, and not too fast.
  bool tellsSpeed(const TimedMotion& step) const;
  /// \brief The next motion begins a step.
  void beginStep();

 private:
  bool ends(const Pose2D& motion, double seconds) const;

  TimedMotion m_rest;             ///< motions that tell no speed yet
  int m_restCount = 0;            ///< of these motions
  bool m_restIsShort = true;      ///< each of them is much shorter than usual
  double m_usual = 0.1;           ///< length of a motion, s; at first that of most LiDARs
  std::optional<double> m_speed;  ///< of the last step, m/s
};

}  // namespace polemcl
