#include <mrpt/opengl/stock_objects.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <sstream>

#include <polemcl/mrpt/observation/CObservationPoles.h>
#include "core/common/Transform.h"
#include "io/file/ReadLimits.h"
#include "mrpt/common/BoundedRead.h"
#include "mrpt/drawing/SceneParts.h"

IMPLEMENTS_SERIALIZABLE(CObservationPoles, CObservation, polemcl)

// For loading the library as a plugin. After the line above, which names the class. An
// MRPT_INITIALIZER would run before it with Clang.
[[maybe_unused]] static const bool kCObservationPolesIsRegistered =
    (mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(CObservationPoles, polemcl)), true);

namespace polemcl {

using mrpt::serialization::CArchive;

uint8_t CObservationPoles::serializeGetVersion() const {
  return 2;  // 1: with the time offsets of the poles; 2: with the turning rates
}

void CObservationPoles::serializeTo(CArchive& out) const {
  for (const std::size_t count : {sensorLabel.size(), poles.size(), visibilityRange.size()})
    if (count > io::kMostOfAScan)
      throw Error("a scan with " + std::to_string(count) +
                  " poles, visibility ranges or bytes of its label cannot be stored; at most " +
                  std::to_string(io::kMostOfAScan) + " are allowed of each");
  out << timestamp << sensorLabel << sensorPose << points;
  out << static_cast<std::uint32_t>(poles.size());
  for (const auto& pole : poles) writePole(out, pole, pole.points);
  out << visibilityRange;
  for (const auto& pole : poles) out << pole.timeOffset;
  for (const auto& pole : poles) out << pole.turnRate;
}

void CObservationPoles::serializeFrom(CArchive& in, uint8_t version) {
  if (version > 2) MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
  in >> timestamp;
  sensorLabel = readText(in, io::kMostOfAScan, "sensor label");
  in >> sensorPose >> points;
  sensorPose.yaw();  // MRPT computes it late, which two threads must not do
  poles.clear();
  // One by one: a count in a damaged file must not decide how much memory is allocated.
  for (std::uint32_t left = readCount(in, io::kMostOfAScan, "poles"); left > 0; --left)
    poles.push_back(readPole(in, &PoleDetection::points));
  visibilityRange = readFloats(in, io::kMostOfAScan, "visibility ranges");
  if (version < 1) return;
  for (auto& pole : poles) in >> pole.timeOffset;
  if (version < 2) return;
  for (auto& pole : poles) in >> pole.turnRate;
}

Pose2D CObservationPoles::planarSensorPose() const {
  return {sensorPose.x(), sensorPose.y(), sensorPose.yaw()};
}

std::vector<PoleDetection> CObservationPoles::polesInRobotFrame() const {
  std::vector<PoleDetection> poles_robot;
  poles_robot.reserve(poles.size());
  const Pose2D T_robot_sensor = planarSensorPose();
  for (const auto& pole : poles) poles_robot.push_back(moved(T_robot_sensor, pole));
  return poles_robot;
}

void CObservationPoles::setSensorPose(const mrpt::poses::CPose3D& newSensorPose) {
  sensorPose = newSensorPose;
  sensorPose.yaw();
}

void CObservationPoles::getDescriptionAsText(std::ostream& o) const {
  CObservation::getDescriptionAsText(o);
  o << "Sensor pose on the robot: " << sensorPose << "\n"
    << "Valid points of the scan: " << points << "\n"
    << "Directions with a visibility range: " << visibilityRange.size() << "\n"
    << "Poles: " << poles.size() << " (planar sensor frame, m)\n";
  if (poles.empty()) return;
  std::ostringstream table;
  table << std::fixed << std::setprecision(3)
        << "        x         y   radius   bottom      top  confidence  std_x  std_y  points\n";
  for (const auto& pole : poles)
    table << std::setw(9) << pole.x << ' ' << std::setw(9) << pole.y << ' ' << std::setw(8)
          << pole.radius << ' ' << std::setw(8) << pole.bottom << ' ' << std::setw(8) << pole.top
          << ' ' << std::setw(11) << pole.confidence << ' ' << std::setw(6)
          << std::sqrt(pole.covariance(0, 0)) << ' ' << std::setw(6)
          << std::sqrt(pole.covariance(1, 1)) << ' ' << std::setw(7) << pole.points << "\n";
  o << table.str();
}

std::string CObservationPoles::exportTxtHeader() const {
  return "NUM_POLES then for each X_M Y_M RADIUS_M BOTTOM_M TOP_M CONFIDENCE";
}

std::string CObservationPoles::exportTxtDataRow() const {
  std::ostringstream row;
  row << poles.size() << std::fixed << std::setprecision(5);
  for (const auto& pole : poles)
    row << ' ' << pole.x << ' ' << pole.y << ' ' << pole.radius << ' ' << pole.bottom << ' '
        << pole.top << ' ' << pole.confidence;
  return row.str();
}

void CObservationPoles::getVisualizationInto(viz::CSetOfObjects& o) const {
  constexpr double kStep = 10;  // of the ground's grid, m
  Eigen::AlignedBox2d around(Eigen::Vector2d(-kStep, -kStep), Eigen::Vector2d(kStep, kStep));
  const auto polesHere = polesInRobotFrame();
  for (const auto& pole : polesHere) around.extend(Eigen::Vector2d(pole.x, pole.y));
  o.insert(scene::makeGround(around, kStep));
  const auto axes = mrpt::opengl::stock_objects::CornerXYZSimple(1.0f, 3.0f);
  axes->setPose(sensorPose);
  o.insert(axes);
  for (const auto& pole : polesHere) {
    o.insert(scene::makeEllipse(pole));
    const double sure = std::clamp(pole.confidence, 0.0, 1.0);
    const auto strength = static_cast<std::uint8_t>(80 + 175 * sure);
    scene::drawPole(o, pole.x, pole.y, pole.radius, pole.bottom, pole.top,
                    mrpt::img::TColor(strength, 60, 30), "pole");
  }
}

}  // namespace polemcl
