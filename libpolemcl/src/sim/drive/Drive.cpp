#include "sim/drive/Drive.h"

#include <cmath>

#include "core/common/Angles.h"

namespace polemcl::sim {
namespace {

/// \brief Slow sway about zero with the given standard deviation: two waves over the path length.
class Sway {
 public:
  Sway(double sigma, double wavelength, Random& random)
      : m_amplitude(sigma),
        m_first(wavelength * random.uniform(0.8, 1.2)),
        m_second(m_first * random.uniform(0.3, 0.45)),
        m_phase(random.uniform(0, 2 * M_PI)) {}
  double at(double s) const {
    return m_amplitude * (std::sin(2 * M_PI * s / m_first + m_phase) +
                          std::sin(2 * M_PI * s / m_second + 2 * m_phase));
  }

 private:
  double m_amplitude, m_first, m_second, m_phase;
};

struct Sways {
  Sway lane, roll, pitch;
  explicit Sways(Random random)
      : lane(0.12, 60, random), roll(0.004, 14, random), pitch(0.004, 11, random) {}
};

/// \brief Pose of the sensor at path length s: perpendicular to the slope, with a little sway. The
/// path is that of the place at which x and y of the origin are 0.
Eigen::Isometry3d sensorAt(const World& world, const SimulationOptions& options, const Sways& sways,
                           double s) {
  const auto place = [&](double at) {
    const double lateral = options.laneOffset + sways.lane.at(at);
    const Street& way = world.path(options.detour);
    return options.reverse ? way.at(way.length() - at, -lateral) : way.at(at, lateral);
  };
  const Pose2D here = place(s), ahead = place(s + 1.0), back = place(s - 1.0);
  const double yaw = std::atan2(ahead.y - back.y, ahead.x - back.x);
  const Eigen::Vector2d forward(std::cos(yaw), std::sin(yaw)), left(-forward.y(), forward.x());
  const auto ground = [&](double x, double y) {
    return world.terrain().height(here.x + x * forward.x() + y * left.x(),
                                  here.y + x * forward.y() + y * left.y());
  };
  const double pitch = -std::atan2(ground(1.3, 0) - ground(-1.3, 0), 2.6);  // nose up is negative
  const double roll = std::atan2(ground(0, 0.75) - ground(0, -0.75), 1.5);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(pitch + sways.pitch.at(s), Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(roll + sways.roll.at(s), Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  const double level =
      0.25 * (ground(1.3, 0.75) + ground(1.3, -0.75) + ground(-1.3, 0.75) + ground(-1.3, -0.75));
  pose.translation() =
      Eigen::Vector3d(here.x, here.y, level) +
      pose.linear() * Eigen::Vector3d(options.originX, options.originY, options.height);
  return pose;
}

Pose2D planar(const Eigen::Isometry3d& pose) {
  return {pose.translation().x(), pose.translation().y(),
          std::atan2(pose.linear()(1, 0), pose.linear()(0, 0))};
}

}  // namespace

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

Eigen::Isometry3d cloudFrame(const Eigen::Isometry3d& T_map_sensor,
                             const SimulationOptions& options) {
  return T_map_sensor * Eigen::Translation3d(-options.originX, -options.originY, -options.originZ);
}

Drive makeDrive(const World& world, const SimulationOptions& options) {
  options.validate();
  Drive drive;
  const Sways sways(
      Random(driveSeed(options, hash(options.world.seed, 0xd21feull, options.world.day))));
  Random noise(driveSeed(options, hash(options.world.seed, 0x0d0ull, options.world.day)));
  WheelOdometry wheels(
      options.odometryBias,
      Random(driveSeed(options, hash(options.world.seed, 0x33ee15ull, options.world.day))));
  // One metre at both ends is not driven, because the heading needs neighbours.
  const int fits =
      static_cast<int>((world.path(options.detour).length() - 2) / options.spacing) + 1;
  const int count = options.scans > 0 ? std::min(options.scans, fits) : fits;
  if (count < 2) throw Error("[world] length_m: the street is shorter than two scans");
  for (int i = 0; i < count; ++i) {
    drive.time.push_back(i * options.spacing / options.speed);
    drive.T_map_sensor.push_back(sensorAt(world, options, sways, 1 + i * options.spacing));
    if (i == 0) continue;
    const Pose2D before = planar(cloudFrame(drive.T_map_sensor[i - 1], options));
    const Pose2D step = relative(before, planar(cloudFrame(drive.T_map_sensor[i], options)));
    if (options.odometry == OdometryModel::wheels) {
      drive.odometry.push_back(wheels.read(step));
      continue;
    }
    OdometryStep odometry;
    odometry.sx = options.odometryNoise * std::abs(step.x);
    odometry.sy = options.odometryNoise * std::abs(step.y);
    odometry.syaw = options.odometryNoise * std::abs(step.yaw);
    odometry.dx = step.x * (1 + options.odometryBias.scale) + odometry.sx * noise.normal();
    odometry.dy = step.y + odometry.sy * noise.normal();
    odometry.dyaw = step.yaw + options.odometryBias.yaw * step.x + odometry.syaw * noise.normal();
    drive.odometry.push_back(odometry);
  }
  return drive;
}

}  // namespace polemcl::sim
