#pragma once
/// \file SensorThread.h
/// \brief One sensor of MRPT in a thread of its own. Part of the module libpolemcl-sensors.so.

#include <mrpt/config/CConfigFileBase.h>

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "mrpt/live/CUdpOdometry.h"
#include "mrpt/live/LiveSensors.h"
#include "mrpt/live/PacketSource.h"

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
  void work(const SensorEvents& events);
  bool process(const SensorEvents& events);
  void tellOdometry(const SensorEvents& events);
  void tellPackets(const SensorEvents& events);
  bool waitUntil(std::chrono::steady_clock::time_point next);

  std::string m_section, m_driver, m_place;  ///< m_place: for messages
  mrpt::hwdrivers::CGenericSensor::Ptr m_sensor;
  const PacketReceiver* m_receiver = nullptr;  ///< m_sensor, if it is one
  const CUdpOdometry* m_odometry = nullptr;    ///< m_sensor, if it is one
  PacketReceiver::Counts m_told;               ///< those already reported
  bool m_warned = false;                       ///< of a packet of odometry
  std::size_t m_observed = 0;                  ///< observations until now
  std::mutex m_mutex;
  std::condition_variable m_stopping;
  bool m_stop = false;
  std::thread m_thread;  ///< last: it uses all of the above
};

}  // namespace polemcl
