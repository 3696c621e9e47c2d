#pragma once
/// \file CUdpOdometry.h
/// \brief Odometry from the network, as a sensor of MRPT: its own drivers give none.

#include <mrpt/hwdrivers/CGenericSensor.h>

#include <optional>
#include <string>

#include "mrpt/live/UdpSocket.h"

namespace polemcl {

/// \brief Gives a CObservationOdometry for each UDP packet.
///
/// A packet is text: `x y yaw`, the pose of the robot in the frame of the odometry, m, m, rad,
/// counterclockwise; then, if it is known, the time of that pose, Unix time, s. Without it, the
/// time is that of the arrival, as for a LiDAR without GPS. Packets that are not three or four
/// finite numbers are ignored, as are those whose time is more than 10 s from the clock here. In
/// MRPT's `rawlog-grabber` the class is known once the module libpolemcl-sensors.so is loaded as a
/// plugin. Keys: `udp_port` (1 to 65535) and `address`, the IPv4 address to listen at (default:
/// 127.0.0.1, this computer only; 0.0.0.0: from anywhere).
class CUdpOdometry : public mrpt::hwdrivers::CGenericSensor {
  DEFINE_GENERIC_SENSOR(CUdpOdometry)
 public:
  CUdpOdometry() { m_sensorLabel = "odometry"; }
  /// \throws std::exception when the port cannot be listened at.
  void initialize() override;
  /// \brief Waits a few milliseconds at most.
  void doProcess() override;
  /// \brief What the first packet that was ignored held; none yet.
  const std::optional<std::string>& ignored() const { return m_ignored; }

 protected:
  void loadConfig_sensorSpecific(const mrpt::config::CConfigFileBase& config,
                                 const std::string& section) override;

 private:
  void take(const UdpPacket& packet);

  int m_port = 0;
  UdpSocket m_socket;
  std::string m_address = "127.0.0.1";
  std::optional<std::string> m_ignored;
};

}  // namespace polemcl
