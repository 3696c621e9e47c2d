#pragma once
/// \file OdometryTrack.h
/// \brief Odometry readings over time, asked for poses in between.

#include <map>
#include <optional>

#include "core/common/Types.h"

namespace polemcl {

/// \brief Readings in any order. Poses are in odometry's own frame.
class OdometryTrack {
 public:
  /// \brief Poses are held this long before the first and after the last reading, s.
  static constexpr double reach = 0.5;

  void add(double time, const Pose2D& pose) { m_readings[time] = pose; }
  bool empty() const { return m_readings.empty(); }
  /// \brief True when there is a reading at `time` or later.
  bool reaches(double time) const {
    return !m_readings.empty() && m_readings.rbegin()->first >= time;
  }
  /// \brief Interpolated between the readings around `time`; none beyond `reach`.
  std::optional<Pose2D> at(double time) const;
  /// \brief Drops readings that poses at `time` or later do not need.
  void forgetBefore(double time);

 private:
  std::map<double, Pose2D> m_readings;  ///< s
};

}  // namespace polemcl
