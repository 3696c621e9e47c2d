#include "mrpt/live/COusterScanner.h"

#include <mrpt/maps/CSimplePointsMap.h>

#include <algorithm>
#include <utility>

#include <polemcl/core/common/Types.h>

IMPLEMENTS_GENERIC_SENSOR(COusterScanner, polemcl)

namespace polemcl {
namespace {

constexpr int kUsualPort = 7502;
constexpr std::uint32_t kMostMissingTurns = 10;  // more are a restart of the LiDAR

// Known as soon as the module is loaded.
[[maybe_unused]] const bool kOusterRegistered = (COusterScanner::doRegister(), true);

mrpt::Clock::duration ticks(double seconds) {
  return std::chrono::duration_cast<mrpt::Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

void COusterScanner::loadConfig_sensorSpecific(const mrpt::config::CConfigFileBase& config,
                                               const std::string& section) {
  m_metadata = config.read_string(section, "metadata_file", m_metadata);
  m_port = config.read_int(section, "data_port", m_port);
  m_useSensorTime = config.read_bool(section, "sensor_time", m_useSensorTime);
  const auto number = [&](const char* key) { return config.read_double(section, key, 0); };
  m_pose = mrpt::poses::CPose3D(
      number("pose_x"), number("pose_y"), number("pose_z"), mrpt::DEG2RAD(number("pose_yaw")),
      mrpt::DEG2RAD(number("pose_pitch")), mrpt::DEG2RAD(number("pose_roll")));
  m_source.loadConfig(config, section);
}

void COusterScanner::initialize() {
  if (m_metadata.empty())
    throw Error(
        "metadata_file: name the JSON file that the LiDAR gives at "
        "http://ADDRESS/api/v1/sensor/metadata");
  m_packets.emplace(m_metadata);
  if (m_port == 0) m_port = m_packets->port() > 0 ? m_packets->port() : kUsualPort;
  m_source.open({{"data_port", m_port}});
}

void COusterScanner::doProcess() {
  m_state = ssWorking;
  m_source.receive([this](std::size_t, const UdpPacket& packet) { take(packet); });
}

void COusterScanner::take(const UdpPacket& packet) {
  if (packet.size != m_packets->size()) {
    ++m_counts.ignored;
    return;
  }
  ++m_counts.packets;
  countLost(packet.bytes);
  const auto most =
      static_cast<std::size_t>(2 * m_packets->columns() / m_packets->columnsPerPacket() + 1);
  if (m_time && (m_packets->turnOf(packet.bytes) != m_number || m_packetsOfTurn >= most)) endTurn();
  if (!m_time) beginTurn(packet);
  m_packets->appendPoints(packet.bytes, m_points);
  ++m_packetsOfTurn;
}

void COusterScanner::beginTurn(const UdpPacket& packet) {
  m_number = m_packets->turnOf(packet.bytes);
  const double sinceBegin =
      m_packets->turn() * m_packets->columnOf(packet.bytes) / m_packets->columns();
  const double measured = m_packets->timeOf(packet.bytes);
  if (m_useSensorTime) {
    m_time = mrpt::Clock::fromDouble(measured - sinceBegin);
    return;
  }
  // A packet is sent when its last column is measured.
  const double packing = m_packets->turn() * m_packets->columnsPerPacket() / m_packets->columns();
  m_time = packet.arrival - ticks(sinceBegin + packing);
}

void COusterScanner::endTurn() {
  if (!m_isFirstTurn) {
    auto points = mrpt::maps::CSimplePointsMap::Create();
    points->reserve(m_points.x.size());
    for (std::size_t i = 0; i < m_points.x.size(); ++i)
      points->insertPointFast(m_points.x[i], m_points.y[i], m_points.z[i]);
    auto turn = mrpt::obs::CObservationPointCloud::Create();
    turn->timestamp = *m_time;
    turn->sensorLabel = m_sensorLabel;
    turn->sensorPose = m_pose;
    turn->pointcloud = points;
    appendObservation(turn);
  }
  m_isFirstTurn = false;
  m_time.reset();
  m_packetsOfTurn = 0;
  for (auto* values : {&m_points.x, &m_points.y, &m_points.z}) values->clear();
}

/// Packets that are sent between this one and the last one.
void COusterScanner::countLost(std::string_view packet) {
  const int perTurn =
      (m_packets->columns() + m_packets->columnsPerPacket() - 1) / m_packets->columnsPerPacket();
  const std::uint32_t number = m_packets->turnOf(packet);
  const int index = std::min(m_packets->columnOf(packet) / m_packets->columnsPerPacket(), perTurn);
  const auto last = std::exchange(m_last, std::pair(number, index));
  if (!last) return;
  std::uint32_t turns = number - last->first;
  if (m_packets->turnNumbers() > 0) turns %= m_packets->turnNumbers();
  if (turns > kMostMissingTurns) return;
  const int end = static_cast<int>(turns) * perTurn + index;
  for (int i = last->second + 1; i < end; ++i)
    if (m_packets->isSent(i % perTurn)) ++m_counts.lost;
}

}  // namespace polemcl
