#include "localizer/ScanOdometry.h"

#include <cmath>

#include "core/common/Covariance.h"

namespace polemcl {
namespace {

bool isFinite(const Pose2D& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.yaw);
}

}  // namespace

void ScanOdometry::add(const OdometryReading& next) {
  if (!std::isfinite(next.time) || !isFinite(next.pose))
    throw Error("odometry: time, x, y and yaw must be finite");
  if (m_reading && next.time <= m_reading->time) return;
  m_track.add(next.time, next.pose);
  OdometryReading taken = next;
  taken.pose = *m_track.at(next.time);
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

Pose2D ScanOdometry::addAtScan(double time, const Pose2D& pose) {
  m_track.add(time, pose);
  const auto added = m_track.at(time);
  if (!added) throw Error("odometry: x, y and yaw must be finite");
  return *added;
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
