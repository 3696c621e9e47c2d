#pragma once
/// \file SensorThread.h
/// \brief One sensor of MRPT in a thread of its own. Part of the module libpolemcl-sensors.so.

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/hwdrivers/CVelodyneScanner.h>

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "mrpt/live/CUdpOdometry.h"
#include "mrpt/live/LiveSensors.h"
#include "mrpt/live/VelodyneReceiver.h"

namespace polemcl {

class SensorThread {
 public:
  /// \brief Opens the device. \throws Error with file and section, see startSensors().
  /// \param config The content of `file`; gets defaults of ours.
  SensorThread(const std::string& file, const std::string& section,
               mrpt::config::CConfigFileBase& config);
  ~SensorThread();
  SensorThread(const SensorThread&) = delete;
  SensorThread& operator=(const SensorThread&) = delete;

  /// \param events Must outlive this object.
  void start(const SensorEvents& events);

 private:
  void open(mrpt::config::CConfigFileBase& config);
  void openPcap(mrpt::config::CConfigFileBase& config);
  void work(const SensorEvents& events);
  bool process(const SensorEvents& events);
  void tellOdometry(const SensorEvents& events);
  void tellPackets(const SensorEvents& events);
  bool processPcap(const SensorEvents& events);
  bool waitUntil(std::chrono::steady_clock::time_point next);

  std::string m_section, m_driver, m_place;  ///< m_place: for messages
  std::string m_pcap;  ///< file of packets of a Velodyne in place of the device; or empty
  mrpt::hwdrivers::CGenericSensor::Ptr m_sensor;
  mrpt::hwdrivers::CVelodyneScanner* m_player = nullptr;  ///< m_sensor, if it plays m_pcap
  const VelodyneReceiver* m_receiver = nullptr;           ///< m_sensor, if it is one
  const CUdpOdometry* m_odometry = nullptr;               ///< m_sensor, if it is one
  VelodyneReceiver::Counts m_told;                        ///< those already reported
  bool m_warned = false;                                  ///< of a packet of odometry
  std::size_t m_packets = 0;                              ///< of the file, before the first turn
  std::size_t m_turns = 0;
  std::mutex m_mutex;
  std::condition_variable m_stopping;
  bool m_stop = false;
  std::thread m_thread;  ///< last: it uses all of the above
};

}  // namespace polemcl
