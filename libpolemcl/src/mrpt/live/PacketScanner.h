#pragma once
/// \file PacketScanner.h
/// \brief Turns of an Ouster or a Hesai from their UDP packets, as sensors of MRPT. Part of the
/// module libpolemcl-sensors.so.

#include <mrpt/hwdrivers/CGenericSensor.h>

#include <memory>
#include <optional>
#include <string>

#include "mrpt/live/LidarPackets.h"
#include "mrpt/live/PacketSource.h"

namespace polemcl {

/// \brief Gives a CObservationPointCloud for each turn.
///
/// The time of a turn is that of its begin (`[sensor] stamp_turn = 0`), from the arrival of its
/// first packet, or with `sensor_time = true` as the LiDAR states it: its clock must then be set to
/// Unix time (UTC). The first turn is left out: it is not complete. Keys: `data_port`,
/// `sensor_time`, `pose_x`, …, `pose_roll` (m, degrees), those of PacketSource, and one for the
/// file that describes the LiDAR.
class PacketScanner : public mrpt::hwdrivers::CGenericSensor, public PacketReceiver {
 public:
  /// \throws Error as makePackets() and PacketSource::open().
  void initialize() override;
  /// \brief Waits a few milliseconds at most.
  void doProcess() override;

 protected:
  void loadConfig_sensorSpecific(const mrpt::config::CConfigFileBase& config,
                                 const std::string& section) override;
  /// \param key Of the file that describes the LiDAR. \param advice What that file is, for errors.
  PacketScanner(const char* label, const char* key, const char* advice)
      : m_key(key), m_advice(advice) {
    m_sensorLabel = label;
  }
  /// \param file That describes the LiDAR. \throws Error when it cannot be read.
  virtual std::unique_ptr<LidarPackets> makePackets(const std::string& file) const = 0;

 private:
  void take(const UdpPacket& packet);
  bool isNewTurn(double phase, double time, double turn) const;
  void beginTurn(const UdpPacket& packet, int column, double phase);
  void endTurn();
  void countLost(std::string_view packet);

  const char *m_key, *m_advice;
  std::string m_description;  ///< file that describes the LiDAR
  int m_port = 0;             ///< 0: the usual one
  bool m_useSensorTime = false;
  mrpt::poses::CPose3D m_pose;
  std::unique_ptr<LidarPackets> m_packets;
  std::optional<mrpt::Clock::time_point> m_begin;  ///< of the turn; none before its first column
  double m_clock = 0;                              ///< the same by the clock of the LiDAR, s
  double m_phase = 0;                              ///< of the last column
  std::size_t m_columns = 0;                       ///< of the turn until now
  LidarPoints m_points;                            ///< of the turn
  bool m_isFirstTurn = true;
  std::optional<std::uint64_t> m_number;  ///< of the last packet
};

/// \brief `metadata_file`: see OusterPackets, also for the frame of the points.
class COusterScanner : public PacketScanner {
  DEFINE_GENERIC_SENSOR(COusterScanner)
 public:
  COusterScanner();

 protected:
  std::unique_ptr<LidarPackets> makePackets(const std::string& file) const override;
};

/// \brief `calibration_file`: see HesaiPackets, also for the frame of the points.
class CHesaiScanner : public PacketScanner {
  DEFINE_GENERIC_SENSOR(CHesaiScanner)
 public:
  CHesaiScanner();

 protected:
  std::unique_ptr<LidarPackets> makePackets(const std::string& file) const override;
};

}  // namespace polemcl
