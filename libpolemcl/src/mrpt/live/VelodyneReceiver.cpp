#include "mrpt/live/VelodyneReceiver.h"

#include <mrpt/hwdrivers/CGPSInterface.h>

#include <cmath>
#include <cstring>
#include <mutex>

#include <polemcl/core/common/Types.h>

namespace polemcl {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kHour = 3600000000u;  // us
/// Other times between two packets are a step of their clock or a pause of the LiDAR, us.
constexpr std::uint32_t kShortestGap = 100, kLongestGap = 500000;

/// A time in the hour of a LiDAR as a whole time. \param near Less than half an hour away.
mrpt::Clock::time_point inItsHour(std::uint32_t microseconds, mrpt::Clock::time_point near) {
  const auto begin = mrpt::Clock::fromDouble(0);
  const auto hours = std::chrono::floor<std::chrono::hours>(near - begin);
  const auto time = begin + hours + std::chrono::microseconds(microseconds);
  if (time - near > 30min) return time - 1h;
  return near - time > 30min ? time + 1h : time;
}

}  // namespace

void VelodyneReceiver::loadConfig_sensorSpecific(const mrpt::config::CConfigFileBase& config,
                                                 const std::string& section) {
  // MRPT 2.5.8 passes over a calibration that cannot be read, and MRPT 2.14.7 does not name it.
  const std::string calibration = config.read_string(section, "calibration_file", "");
  if (!calibration.empty() && !loadCalibrationFile(calibration)) m_missing = calibration;
  if (!m_missing.empty()) return;
  CVelodyneScanner::loadConfig_sensorSpecific(config, section);
  m_model = config.read_enum(section, "model", m_model);  // MRPT reads it, but does not use it
  m_dataPort = config.read_int(section, "data_port", m_dataPort);
  m_positionPort = config.read_int(section, "position_port", m_positionPort);
  m_source.loadConfig(config, section);
  m_rpm = config.read_int(section, "rpm", m_rpm);
  m_returnType = config.read_enum(section, "return_type", m_returnType);
}

void VelodyneReceiver::initialize() {
  if (!m_missing.empty())
    throw Error("calibration_file = " + m_missing + ": cannot be read as XML of a Velodyne");
  if (!m_pcap_output_file.empty())
    throw Error("pcap_output: no PCAP is written; record with tcpdump -w FILE.pcap udp");
  if (m_velodyne_calib.empty()) loadDefaultCalibration();
  if (m_source.pcap().empty()) changeSettings();
  m_source.open({{"data_port", m_dataPort}, {"position_port", m_positionPort}});
}

void VelodyneReceiver::loadDefaultCalibration() {
  const std::string model = mrpt::typemeta::TEnumType<model_t>::value2name(m_model);
  m_velodyne_calib = mrpt::obs::VelodyneCalibration::LoadDefaultCalibration(model);
  if (m_velodyne_calib.empty())
    throw Error("model = " + model + ": has no calibration in MRPT: set calibration_file");
}

/// MRPT sends them to the web page of the LiDAR.
void VelodyneReceiver::changeSettings() {
  if (m_rpm > 0 && !setLidarRPM(m_rpm))
    throw Error("rpm = " + std::to_string(m_rpm) + ": the LiDAR at " + m_device_ip +
                " does not take it");
  if (m_returnType != UNCHANGED && !setLidarReturnType(m_returnType))
    throw Error("return_type: the LiDAR at " + m_device_ip + " does not take it");
}

void VelodyneReceiver::doProcess() {
  m_state = ssWorking;
  m_source.receive([this](std::size_t port, const UdpPacket& packet) {
    if (port == 0) {
      if (const auto data = accepted<Scan::TVelodyneRawPacket>(packet))
        takeData(*data, packet.arrival);
    } else if (const auto position = accepted<Scan::TVelodynePositionPacket>(packet)) {
      takePosition(*position, packet.arrival);
    }
  });
}

template <class Packet>
std::optional<Packet> VelodyneReceiver::accepted(const UdpPacket& packet) {
  if (packet.size != sizeof(Packet)) {
    ++m_counts.ignored;
    return std::nullopt;
  }
  m_source.keepTo(packet.sender);
  Packet content;
  std::memcpy(&content, packet.bytes.data(), sizeof content);
  return content;
}

void VelodyneReceiver::takePosition(const Scan::TVelodynePositionPacket& packet, Time arrival) {
  const std::chrono::duration<double> period(m_pos_packets_min_period);
  if (m_position && arrival - *m_position < period) return;
  m_position = arrival;
  static std::mutex ofParser;  // MRPT's keeps the last date for all receivers
  const std::lock_guard lock(ofParser);
  const char* const text = packet.NMEA_GPRMC;
  mrpt::obs::CObservationGPS fix;
  using Rmc = mrpt::obs::gnss::Message_NMEA_RMC;
  if (!mrpt::hwdrivers::CGPSInterface::parse_NMEA({text, strnlen(text, sizeof packet.NMEA_GPRMC)},
                                                  fix))
    return;
  const auto* const rmc = fix.getMsgByClassPtr<Rmc>();
  if (rmc && rmc->fields.validity_char == 'A')
    m_gps = {rmc->fields.UTCTime.getAsTimestamp(rmc->getDateAsTimestamp()), arrival};
}

void VelodyneReceiver::takeData(const Scan::TVelodyneRawPacket& packet, Time arrival) {
  ++m_counts.packets;
  countLost(packet.gps_timestamp());
  if (m_turn && (packet.blocks[0].rotation() < m_turn->scan_packets.back().blocks[0].rotation() ||
                 m_turn->scan_packets.size() >= kMostPackets)) {
    if (!m_isFirstTurn) appendObservation(m_turn);
    m_isFirstTurn = false;
    m_turn.reset();
    m_spacing = m_nextSpacing;
    m_nextSpacing = 0;
  }
  if (!m_turn) beginTurn(packet, arrival);
  m_turn->scan_packets.push_back(packet);
}

void VelodyneReceiver::beginTurn(const Scan::TVelodyneRawPacket& packet, Time arrival) {
  m_turn = Scan::Create();
  m_turn->sensorLabel = m_sensorLabel + "_SCAN";
  m_turn->sensorPose = m_sensorPose;
  m_turn->calibration = m_velodyne_calib;
  m_turn->maxRange = TModelPropertiesFactory::get().at(m_model).maxRange;
  m_turn->originalReceivedTimestamp = arrival;
  const std::chrono::duration<double> timeout(m_pos_packets_timing_timeout);
  // A file counts as measured when it is played, as the odometry beside it is.
  m_turn->has_satellite_timestamp =
      m_source.pcap().empty() && m_gps && arrival - m_gps->arrival < timeout;
  m_turn->timestamp =
      m_turn->has_satellite_timestamp ? inItsHour(packet.gps_timestamp(), m_gps->time) : arrival;
}

/// Packets come evenly, so a longer time between two means that some are missing.
void VelodyneReceiver::countLost(std::uint32_t clock) {
  const std::uint32_t before = m_clock.value_or(clock);
  m_clock = clock;
  const std::uint32_t gap = clock >= before ? clock - before : clock + kHour - before;
  if (gap < kShortestGap || gap > kLongestGap) return;
  if (m_nextSpacing == 0 || gap < m_nextSpacing) m_nextSpacing = gap;
  if (m_spacing > 0)
    m_counts.lost += std::max<std::size_t>(1, (gap + m_spacing / 2) / m_spacing) - 1;
}

}  // namespace polemcl
