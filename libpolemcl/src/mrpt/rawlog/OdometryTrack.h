#pragma once
/// \file OdometryTrack.h
/// \brief Odometry readings over time, with interpolation between them.

#include <map>
#include <optional>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief Readings may come in any order. Poses are in the odometry frame.
///
/// A step that no vehicle makes is a jump: the node of an encoder was started anew, or a packet is
/// wrong. Over a jump, the motion before goes on; later readings continue from there. After a gap,
/// a reading at the begin of the odometry is a jump, too, if the motion before leads elsewhere.
class OdometryTrack {
 public:
  /// \brief A longer step between two readings is a jump: kNearestJump + kFastest * dt, m and m/s.
  static constexpr double kNearestJump = 1, kFastest = 70;
  /// \brief The same for the heading, rad and rad/s.
  static constexpr double kLeastTurn = 0.5, kFastestTurn = 10;

  /// \brief After a gap, a reading this near to (0, 0, 0) may be the first of a node that was
  /// started anew, m and rad: its first readings can be lost.
  static constexpr double kNearStart = 1, kTurnedAtStart = 0.2;
  /// \brief It is, if the motion before leads farther away from there than this, m: a vehicle may
  /// come back to where it began.
  static constexpr double kFarFromStart = 10;

  /// \brief For this time before and after the readings, the first and last motion go on, s.
  static constexpr double kReach = 0.5;
  /// \brief Readings that are this far apart tell such a motion; where there are none, the pose
  /// stays, s.
  static constexpr double kBaseline = 0.09;
  /// \brief Longest time between two readings that tell the poses between them, s.
  static constexpr double kLongestGap = 2;

  void add(double time, const Pose2D& pose);
  /// \brief The pose that such a reading would get. Changes nothing.
  Pose2D placed(double time, const Pose2D& pose) const;
  /// \brief Whether such a reading would be a jump.
  bool jumpsTo(double time, const Pose2D& pose) const {
    return isJump(time, compose(m_origin, pose));
  }
  /// \brief Whether a step (m, rad) is one that no vehicle makes. \param seconds Its time.
  static bool isTooFast(const Pose2D& step, double seconds);
  /// \brief Number of jumps so far.
  std::size_t jumps() const { return m_jumps; }
  bool empty() const { return m_readings.empty(); }
  /// \brief Whether there is a reading at `time` or later. If all are later, they must tell the
  /// motion that leads to the first.
  bool reaches(double time) const {
    if (m_readings.empty() || m_readings.rbegin()->first < time) return false;
    const double first = m_readings.begin()->first;
    return first <= time || m_readings.rbegin()->first - first >= kBaseline;
  }
  /// \brief Whether all times from `begin` to `end` lie between readings.
  bool covers(double begin, double end) const {
    return reaches(end) && m_readings.begin()->first <= begin;
  }
  /// \brief Pose interpolated between the readings around `time`; nullopt beyond kReach.
  std::optional<Pose2D> at(double time) const;
  /// \brief Whether at() knows the pose, and between two readings these are not too far apart.
  bool isNear(double time) const;
  /// \brief A pose of at() as the readings since the last jump state it.
  Pose2D asRead(const Pose2D& pose) const { return relative(m_origin, pose); }
  /// \brief Drops readings that are not needed for poses at `time` or later.
  void forgetBefore(double time);
  /// \brief Drops readings later than this: the clock was ahead.
  void forgetAfter(double time);
  /// \brief Drops all readings; the jumps stay counted.
  void clear();

 private:
  bool isJump(double time, const Pose2D& pose) const;
  bool isBreak(double time, const Pose2D& pose) const;
  bool isRestart(double time, const Pose2D& pose) const;
  /// \brief Where the motion before the last reading leads, as kReach and kBaseline say.
  Pose2D afterLast(double time) const;

  std::map<double, Pose2D> m_readings;  ///< s; without jumps
  Pose2D m_origin;                      ///< of the readings since the last jump
  std::size_t m_jumps = 0;
};

}  // namespace polemcl
