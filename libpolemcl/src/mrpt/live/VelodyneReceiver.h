#pragma once
/// \file VelodyneReceiver.h
/// \brief Turns of a Velodyne from its UDP packets, at any rate. Part of the module
/// libpolemcl-sensors.so.

#include <mrpt/hwdrivers/CVelodyneScanner.h>

#include <optional>

#include "mrpt/live/PacketSource.h"

namespace polemcl {

/// \brief Stands in for MRPT's driver, which takes about 900 packets a second and has one pair of
/// ports for all LiDARs.
///
/// It has the keys of the base class, and gives the same observations: a CObservationVelodyneScan
/// for each turn, with the time of arrival of its first packet, or with GPS time. The first turn is
/// left out: it is not complete. Added keys: `data_port`, `position_port` (default: 2368 and 8308)
/// and those of PacketSource.
class VelodyneReceiver : public mrpt::hwdrivers::CVelodyneScanner, public PacketReceiver {
 public:
  /// More than a turn of any Velodyne has. A turn with more is cut: the LiDAR does not turn.
  static constexpr std::size_t kMostPackets = 3000;

  /// \throws Error as PacketSource::open(), and when the LiDAR is of no known model or does not
  /// take the settings of `rpm` and `return_type`.
  void initialize() override;
  /// \brief Waits a few milliseconds at most.
  void doProcess() override;

 protected:
  void loadConfig_sensorSpecific(const mrpt::config::CConfigFileBase& config,
                                 const std::string& section) override;

 private:
  using Scan = mrpt::obs::CObservationVelodyneScan;
  using Time = mrpt::Clock::time_point;
  struct GpsTime {
    Time time, arrival;
  };

  void changeSettings();
  void loadDefaultCalibration();
  /// \return The packet, if it has the right size.
  template <class Packet>
  std::optional<Packet> accepted(const UdpPacket& packet);
  void takePosition(const Scan::TVelodynePositionPacket& packet, Time arrival);
  void takeData(const Scan::TVelodyneRawPacket& packet, Time arrival);
  void beginTurn(const Scan::TVelodyneRawPacket& packet, Time arrival);
  void countLost(std::uint32_t clock);

  int m_dataPort = 2368, m_positionPort = 8308;
  std::string m_missing;  ///< file of the calibration, if it cannot be read
  int m_rpm = 0;          ///< as this and the next one are hidden in the base class
  return_type_t m_returnType = UNCHANGED;
  Scan::Ptr m_turn;  ///< that is not complete
  bool m_isFirstTurn = true;
  std::optional<Time> m_position;        ///< arrival of the last packet of position that was read
  std::optional<GpsTime> m_gps;          ///< the last valid one
  std::optional<std::uint32_t> m_clock;  ///< of the last packet, us since the full hour
  /// Smallest time between two packets in the turn before, and so far in this one, us; 0: unknown.
  std::uint32_t m_spacing = 0, m_nextSpacing = 0;
};

}  // namespace polemcl
