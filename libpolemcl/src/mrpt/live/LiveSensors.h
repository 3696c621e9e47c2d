#pragma once
/// \file LiveSensors.h
/// \brief The sensors of an INI file of MRPT's rawlog-grabber: mrpt::hwdrivers::CGenericSensor.
///
/// MRPT's drivers bring 300 libraries along (cameras, GTK), which would slow the start of every
/// program. So they are in a module of its own, `libpolemcl-sensors.so`, loaded when sensors are
/// started.

#include <mrpt/obs/CObservation.h>

#include <functional>
#include <memory>
#include <string>

namespace polemcl {

/// \brief Where what the sensors tell goes. Called from the threads of the sensors.
struct SensorEvents {
  std::function<void(const mrpt::obs::CObservation::Ptr&)> observed;
  /// A sensor has come to its end (a PCAP file), or has failed with this message.
  std::function<void(const std::string& failure)> ended;
  /// Something is not right, but the sensor goes on.
  std::function<void(const std::string& warning)> warned;
  /// Packets of a LiDAR since the last call: lost on the way; ignored, since another sender or
  /// size.
  std::function<void(std::size_t lost, std::size_t ignored)> counted = {};
};

/// \brief Sensors at work, each in a thread of its own. The destructor ends them and waits.
class LiveSensors {
 public:
  virtual ~LiveSensors() = default;
};

/// \brief Opens the sensors of a file one after the other, then starts all.
///
/// Each section is a sensor, except `[global]` and those with `rawlog-grabber-ignore = true`. Its
/// key `driver` names the class: one of MRPT's, or CUdpOdometry. `process_rate` is how often in a
/// second the driver is asked (default: 1000). The other keys are those of the class. For
/// CVelodyneScanner, VelodyneReceiver listens and adds keys. With `pcap_input`, `pcap_read_once` is
/// true unless set.
/// \throws Error with file and section: no sensor, no or unknown driver, a wrong value, a device
///         that cannot be opened; or the module is missing.
std::unique_ptr<LiveSensors> startSensors(const std::string& file, SensorEvents events);

}  // namespace polemcl
