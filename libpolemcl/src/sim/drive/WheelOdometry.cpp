#include "sim/drive/WheelOdometry.h"

#include <cmath>

#include "core/common/Angles.h"

namespace polemcl::sim {

WheelOdometry::WheelOdometry(const OdometryBias& bias, Random noise)
    : m_bias(bias), m_noise(noise) {}

/// Slow change of an error, -1 to 1.
double WheelOdometry::sway(double wavelength) const {
  return std::sin(2 * M_PI * m_driven / wavelength);
}

OdometryStep WheelOdometry::read(const Pose2D& step) {
  const double metres = std::hypot(step.x, step.y);
  const double forwards = step.x < 0 ? -metres : metres;
  m_driven += metres;
  const double scale = m_bias.scale * (1 + m_bias.drift * sway(400));
  const double yawBias = m_bias.yaw * (1 + m_bias.drift * sway(300));
  m_measured += forwards * (1 + scale) + 0.002 * metres * m_noise.normal();
  const double before = m_counted;
  m_counted = m_bias.tick > 0 ? m_bias.tick * std::round(m_measured / m_bias.tick) : m_measured;
  OdometryStep read;
  read.dyaw = step.yaw * (1 + m_bias.slip) + yawBias * forwards +
              0.01 * degree * std::sqrt(metres) * m_noise.normal();
  // An arc: its chord points half the turn to the side.
  read.dx = (m_counted - before) * std::cos(0.5 * read.dyaw);
  read.dy = (m_counted - before) * std::sin(0.5 * read.dyaw);
  read.sx = 0.02 * metres + 0.002;
  read.sy = 0.01 * metres + 0.002;
  read.syaw = 0.1 * degree * metres + 0.02 * std::abs(step.yaw) + 0.02 * degree;
  return read;
}

}  // namespace polemcl::sim
