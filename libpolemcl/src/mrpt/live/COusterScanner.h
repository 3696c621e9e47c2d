#pragma once
/// \file COusterScanner.h
/// \brief Turns of an Ouster from its UDP packets, as a sensor of MRPT. Part of the module
/// libpolemcl-sensors.so.

#include <mrpt/hwdrivers/CGenericSensor.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <optional>
#include <string>

#include "mrpt/live/OusterPackets.h"
#include "mrpt/live/PacketSource.h"

namespace polemcl {

/// \brief Gives a CObservationPointCloud for each turn; frame as in OusterPackets.
///
/// The time of a turn is when column 0 is measured, from the arrival of its first packet, or with
/// `sensor_time = true` as the LiDAR states it: its clock must then be set to Unix time (UTC). The
/// first turn is left out: it is not complete. Keys: `metadata_file`, `data_port` (default: that of
/// the metadata, else 7502), `sensor_time`, `pose_x`, …, `pose_roll` (m, degrees), and those of
/// PacketSource.
class COusterScanner : public mrpt::hwdrivers::CGenericSensor, public PacketReceiver {
  DEFINE_GENERIC_SENSOR(COusterScanner)
 public:
  COusterScanner() { m_sensorLabel = "ouster"; }
  /// \throws Error as OusterPackets and PacketSource::open().
  void initialize() override;
  /// \brief Waits a few milliseconds at most.
  void doProcess() override;

 protected:
  void loadConfig_sensorSpecific(const mrpt::config::CConfigFileBase& config,
                                 const std::string& section) override;

 private:
  void take(const UdpPacket& packet);
  void endTurn();
  void beginTurn(const UdpPacket& packet);
  void countLost(std::string_view packet);

  std::string m_metadata;
  int m_port = 0;  ///< 0: that of the metadata
  bool m_useSensorTime = false;
  mrpt::poses::CPose3D m_pose;
  std::optional<OusterPackets> m_packets;
  std::uint32_t m_number = 0;                     ///< of the turn
  std::optional<mrpt::Clock::time_point> m_time;  ///< of the turn; none before the first packet
  OusterPackets::Points m_points;                 ///< of the turn
  std::size_t m_packetsOfTurn = 0;
  bool m_isFirstTurn = true;
  std::optional<std::pair<std::uint32_t, int>> m_last;  ///< turn and index of the last packet
};

}  // namespace polemcl
