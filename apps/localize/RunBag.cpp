#include "localize/RunBag.h"

#include <cmath>
#include <cstdio>

#include "core/common/Angles.h"
#include "io/rosbag/RosMessages.h"
#include "io/rosbag/RosResults.h"

namespace polemcl::apps {
namespace {

constexpr const char *kMap = "map", *kRobot = "base_link";
constexpr double kPathStep = 1;  ///< m

std::uint16_t addTopic(io::McapWriter& bag, const char* name, const char* type,
                       bool latched = false) {
  return bag.addTopic({name, type, io::rosSchema(type), latched});
}

std::string text(double value) {
  char number[32];
  std::snprintf(number, sizeof number, "%.4g", value);
  return number;
}

io::RosDiagnostic diagnosticOf(const LocalizationUpdate& update) {
  const Health& health = update.health;
  io::RosDiagnostic result;
  result.level = health.state == HealthState::ok         ? io::RosDiagnostic::ok
                 : health.state == HealthState::degraded ? io::RosDiagnostic::warning
                                                         : io::RosDiagnostic::error;
  result.name = "pole-localize: pose";
  result.message = name(health.state);
  if (health.state != HealthState::ok) result.message += std::string(": ") + name(health.reason);
  result.values = {{"state", name(health.state)},
                   {"reason", name(health.reason)},
                   {"matched_share", text(health.matchedShare)},
                   {"seen_share", text(health.seenShare)},
                   {"innovation", text(health.innovation)},
                   {"mode_share", text(health.modeShare)},
                   {"spread_m", text(health.spread)},
                   {"spread_deg", text(health.spreadHeading / degree)},
                   {"poles", std::to_string(update.poles)},
                   {"relocalized", update.relocalized ? "1" : "0"}};
  return result;
}

std::string mapMessage(double time, const std::vector<MapPole>& poles) {
  std::vector<io::PoleMarker> markers;
  markers.reserve(poles.size());
  for (const MapPole& pole : poles)
    markers.push_back({pole.x, pole.y, pole.radius, pole.bottom, pole.top, 0.3f, 0.45f, 0.8f});
  return io::encodePoles({time, kMap}, "map_poles", markers);
}

}  // namespace

RunBag::RunBag(const std::filesystem::path& file)
    : m_bag(file),
      m_pose(addTopic(m_bag, "/pose", io::kPoseType)),
      m_transform(addTopic(m_bag, "/tf", io::kTransformsType)),
      m_pathTopic(addTopic(m_bag, "/path", io::kPathType)),
      m_map(addTopic(m_bag, "/map_poles", io::kMarkersType, true)),
      m_poles(addTopic(m_bag, "/poles", io::kMarkersType)),
      m_diagnostics(addTopic(m_bag, "/diagnostics", io::kDiagnosticsType)) {}

void RunBag::add(const LocalizationPipeline& localization, const PoleScan& scan,
                 const LocalizationUpdate& update) {
  m_time = update.time;
  const std::uint64_t time = io::rosNanoseconds(m_time);
  if (!m_begun) m_bag.add(m_map, time, mapMessage(m_time, localization.map().poles->poles()));
  m_begun = true;
  if (update.estimate) addPose(m_time, *update.estimate);
  addPoles(localization, scan);
  m_bag.add(m_diagnostics, time, io::encodeDiagnostic({m_time, ""}, diagnosticOf(update)));
}

void RunBag::addPose(double time, const PoseWithCovariance& pose) {
  const std::uint64_t stamp = io::rosNanoseconds(time);
  m_bag.add(m_transform, stamp, io::encodeTransform({time, kMap}, kRobot, pose.mean));
  m_bag.add(m_pose, stamp, io::encodePose({time, kMap}, pose));
  const Pose2D last = m_path.empty() ? Pose2D() : m_path.back().pose;
  const bool isFar = std::hypot(pose.mean.x - last.x, pose.mean.y - last.y) >= kPathStep;
  if (!m_path.empty() && !isFar) return;
  m_path.push_back({time, pose.mean});
  if (4 * m_path.size() >= 5 * m_pathWritten) addPath(time);
}

void RunBag::addPath(double time) {
  m_bag.add(m_pathTopic, io::rosNanoseconds(time), io::encodePath({time, kMap}, m_path));
  m_pathWritten = m_path.size();
}

void RunBag::addPoles(const LocalizationPipeline& localization, const PoleScan& scan) {
  const std::vector<PoleMatch>& matches = localization.matches();
  std::vector<io::PoleMarker> markers;
  markers.reserve(scan.poles_robot.size());
  for (std::size_t i = 0; i < scan.poles_robot.size(); ++i) {
    const PoleDetection& pole = scan.poles_robot[i];
    const bool matched = i < matches.size() && matches[i].matched;
    markers.push_back({pole.x, pole.y, pole.radius, pole.bottom, pole.top, matched ? 0.1f : 1.0f,
                       matched ? 0.8f : 0.5f, 0.1f});
  }
  m_bag.add(m_poles, io::rosNanoseconds(m_time),
            io::encodePoles({m_time, kRobot}, "poles", markers));
}

void RunBag::commit() {
  if (m_path.size() > m_pathWritten) addPath(m_time);
  m_bag.commit();
}

}  // namespace polemcl::apps
