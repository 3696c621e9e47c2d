#include "localizer/ScanOdometry.h"

#include <cmath>
#include <string>

#include "core/common/Covariance.h"
#include "core/common/DetectionCheck.h"

namespace polemcl {
namespace {

/// Readings go back for longer than this: the clock was set, s.
constexpr double kClockSet = 1;

void requireFinite(double time, const Pose2D& pose) {
  if (!isTimeInSeconds(time))
    throw Error("odometry at " + std::to_string(time) + " s: " + kTimeAllowed);
  if (!std::isfinite(pose.x + pose.y + pose.yaw))
    throw Error("odometry: x, y and yaw must be finite");
}

}  // namespace

void ScanOdometry::add(const OdometryReading& next) {
  requireFinite(next.time, next.pose);
  if (m_reading && next.time <= m_reading->time) {
    if (!m_lateSince || next.time < *m_lateSince) m_lateSince = next.time;
    m_late = next;
    if (next.time - *m_lateSince < kClockSet) return;
    beginAnew();
  } else if (continuesLate(next)) {
    beginAnew();
  }
  m_lateSince.reset();
  m_late.reset();
  m_track.add(next.time, next.pose);
  OdometryReading taken = next;
  taken.pose = *m_track.at(next.time);
  const Velocity velocity = next.velocity.value_or(Velocity());
  if (!std::isfinite(velocity.x + velocity.y + velocity.yaw)) taken.velocity.reset();
  const auto& covariance = next.velocityCovariance;
  if (m_reading && covariance && isCovariance(*covariance) && covariance->trace() > 0) {
    const double seconds = next.time - m_reading->time;
    const Pose2D step = relative(m_reading->pose, taken.pose);
    m_steps.add(m_reading->time, next.time, {step, *covariance * seconds * seconds});
  }
  m_reading = taken;
  m_track.forgetBefore(next.time - Localizer::keptOdometry);
  m_steps.forgetBefore(next.time - Localizer::keptOdometry);
}

/// Whether a reading goes on from those that were left out, and not from the last one that was
/// taken: the clock was set back by less than kClockSet.
bool ScanOdometry::continuesLate(const OdometryReading& next) const {
  return m_late && m_track.jumpsTo(next.time, next.pose) &&
         !OdometryTrack::isTooFast(relative(m_late->pose, next.pose), next.time - m_late->time);
}

/// The next reading is the first one of its clock. Its pose goes on from the readings before.
void ScanOdometry::beginAnew() {
  if (m_before) m_before = m_track.asRead(*m_before);
  m_track.clear();
  m_steps = {};
  m_reading.reset();
}

void ScanOdometry::restart() {
  m_before.reset();
  m_timeBefore = -INFINITY;
}

Pose2D ScanOdometry::atScan(double time, const Pose2D& pose) const {
  requireFinite(time, pose);
  return m_before ? m_track.placed(time, pose) : pose;
}

void ScanOdometry::addAtScan(double time, const Pose2D& pose) {
  if (!m_before) m_track.clear();
  m_track.add(time, pose);
}

std::optional<Velocity> ScanOdometry::velocity() const {
  return m_reading ? m_reading->velocity : std::nullopt;
}

std::optional<PoseWithCovariance> ScanOdometry::motionTo(double time, const Pose2D& pose) const {
  if (!m_before) return std::nullopt;
  const Pose2D motion = relative(*m_before, pose);
  const auto stated = m_steps.covarianceBetween(m_timeBefore, time);
  return PoseWithCovariance{motion,
                            stated ? m_options.covarianceFactor * (*stated + io::floorCovariance())
                                   : motionCovariance(motion, m_options)};
}

void ScanOdometry::pass(double time, const Pose2D& pose) {
  m_track.forgetBefore(m_timeBefore);  // the last motion goes on over a jump
  m_steps.forgetBefore(time);
  m_timeBefore = time;
  m_before = pose;
}

}  // namespace polemcl
