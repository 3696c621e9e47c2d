#pragma once
/// \file OdometryTrack.h
/// \brief Odometry readings over time, with interpolation between them.

#include <map>
#include <optional>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief Readings may come in any order. Poses are in the odometry frame.
class OdometryTrack {
 public:
  /// \brief The first and last pose are also valid for this time before and after the readings, s.
  static constexpr double reach = 0.5;

  void add(double time, const Pose2D& pose) { m_readings[time] = pose; }
  bool empty() const { return m_readings.empty(); }
  /// \brief Whether there is a reading at `time` or later.
  bool reaches(double time) const {
    return !m_readings.empty() && m_readings.rbegin()->first >= time;
  }
  /// \brief Whether all times from `begin` to `end` lie between readings.
  bool covers(double begin, double end) const {
    return reaches(end) && m_readings.begin()->first <= begin;
  }
  /// \brief Pose interpolated between the readings around `time`; nullopt beyond `reach`.
  std::optional<Pose2D> at(double time) const;
  /// \brief Drops readings that are not needed for poses at `time` or later.
  void forgetBefore(double time);

 private:
  std::map<double, Pose2D> m_readings;  ///< s
};

}  // namespace polemcl
