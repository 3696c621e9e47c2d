#include "mrpt/live/PacketScanner.h"

#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cmath>

#include <polemcl/core/common/Types.h>
#include "mrpt/live/HesaiPackets.h"
#include "mrpt/live/OusterPackets.h"

IMPLEMENTS_GENERIC_SENSOR(COusterScanner, polemcl)
IMPLEMENTS_GENERIC_SENSOR(CHesaiScanner, polemcl)

namespace polemcl {
namespace {

constexpr std::size_t kMostInTurn = 20000;     // of a turn; with more, the LiDAR does not turn
constexpr std::uint64_t kMostMissing = 10000;  // packets; more are a restart of the LiDAR
constexpr double kLongestTurn = 1.2;           // as a share of a turn

// Known as soon as the module is loaded.
[[maybe_unused]] const bool kScannersRegistered =
    (COusterScanner::doRegister(), CHesaiScanner::doRegister(), true);

mrpt::Clock::duration ticks(double seconds) {
  return std::chrono::duration_cast<mrpt::Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

void PacketScanner::loadConfig_sensorSpecific(const mrpt::config::CConfigFileBase& config,
                                              const std::string& section) {
  m_description = config.read_string(section, m_key, m_description);
  m_port = config.read_int(section, "data_port", m_port);
  m_useSensorTime = config.read_bool(section, "sensor_time", m_useSensorTime);
  const auto number = [&](const char* key) { return config.read_double(section, key, 0); };
  m_pose = mrpt::poses::CPose3D(
      number("pose_x"), number("pose_y"), number("pose_z"), mrpt::DEG2RAD(number("pose_yaw")),
      mrpt::DEG2RAD(number("pose_pitch")), mrpt::DEG2RAD(number("pose_roll")));
  m_source.loadConfig(config, section);
}

void PacketScanner::initialize() {
  if (m_description.empty()) throw Error(std::string(m_key) + ": name " + m_advice);
  m_packets = makePackets(m_description);
  m_source.open({{"data_port", m_port == 0 ? m_packets->usualPort() : m_port}});
}

void PacketScanner::doProcess() {
  m_state = ssWorking;
  m_source.receive([this](std::size_t, const UdpPacket& packet) { take(packet); });
}

void PacketScanner::take(const UdpPacket& packet) {
  const std::string_view bytes = packet.bytes;
  if (packet.size != bytes.size() || !m_packets->isPacket(bytes)) {
    ++m_counts.ignored;
    return;
  }
  ++m_counts.packets;
  m_source.keepTo(packet.sender);
  countLost(bytes);
  const double turn = m_packets->turn(bytes);
  for (int i = 0; i < m_packets->columns(bytes); ++i) {
    const auto phase = m_packets->phase(bytes, i);
    if (!phase) continue;
    if (m_begin && isNewTurn(*phase, m_packets->time(bytes, i), turn)) endTurn();
    if (!m_begin) beginTurn(packet, i, *phase);
    m_packets->append(bytes, i, m_points);
    m_phase = *phase;
    ++m_columns;
  }
}

bool PacketScanner::isNewTurn(double phase, double time, double turn) const {
  return phase < m_phase || m_columns >= kMostInTurn || time - m_clock > kLongestTurn * turn;
}

void PacketScanner::beginTurn(const UdpPacket& packet, int column, double phase) {
  const double turn = m_packets->turn(packet.bytes), sinceBegin = phase * turn,
               measured = m_packets->time(packet.bytes, column);
  m_clock = measured - sinceBegin;
  if (m_useSensorTime) {
    m_begin = mrpt::Clock::fromDouble(m_clock);
    return;
  }
  // A packet is sent when its last column is measured.
  const int last = m_packets->columns(packet.bytes) - 1;
  m_begin = packet.arrival - ticks(m_packets->time(packet.bytes, last) - m_clock);
}

void PacketScanner::endTurn() {
  if (!m_isFirstTurn) {
    auto points = mrpt::maps::CSimplePointsMap::Create();
    points->reserve(m_points.x.size());
    for (std::size_t i = 0; i < m_points.x.size(); ++i)
      points->insertPointFast(m_points.x[i], m_points.y[i], m_points.z[i]);
    auto turn = mrpt::obs::CObservationPointCloud::Create();
    turn->timestamp = *m_begin;
    turn->sensorLabel = m_sensorLabel;
    turn->sensorPose = m_pose;
    turn->pointcloud = points;
    appendObservation(turn);
  }
  m_isFirstTurn = false;
  m_begin.reset();
  m_columns = 0;
  for (auto* values : {&m_points.x, &m_points.y, &m_points.z}) values->clear();
}

void PacketScanner::countLost(std::string_view packet) {
  const auto number = m_packets->number(packet);
  if (!number) return;
  if (m_number) {
    const std::uint64_t missing = (number->value + 2 * number->end - *m_number - 1) % number->end;
    if (missing <= kMostMissing) m_counts.lost += missing;
  }
  m_number = number->value;
}

COusterScanner::COusterScanner()
    : PacketScanner("ouster", "metadata_file",
                    "the JSON file that the LiDAR gives at "
                    "http://ADDRESS/api/v1/sensor/metadata") {}

std::unique_ptr<LidarPackets> COusterScanner::makePackets(const std::string& file) const {
  return std::make_unique<OusterPackets>(file);
}

CHesaiScanner::CHesaiScanner()
    : PacketScanner("hesai", "calibration_file",
                    "the CSV file of the angles of the LiDAR, with the columns channel, elevation "
                    "and azimuth") {}

std::unique_ptr<LidarPackets> CHesaiScanner::makePackets(const std::string& file) const {
  return std::make_unique<HesaiPackets>(file);
}

}  // namespace polemcl
