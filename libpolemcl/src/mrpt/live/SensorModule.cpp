/// \file SensorModule.cpp
/// \brief The module libpolemcl-sensors.so: see LiveSensors.h.

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <pthread.h>

#include <condition_variable>
#include <csignal>
#include <fstream>
#include <iterator>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "config/PlainText.h"
#include "io/file/InputFile.h"
#include "mrpt/common/MrptReason.h"
#include "mrpt/live/CUdpOdometry.h"
#include "mrpt/live/LiveSensors.h"
#include "mrpt/live/PacketSource.h"
#include "mrpt/live/VelodyneReceiver.h"

namespace polemcl {

using mrpt::config::CConfigFileBase;
using mrpt::hwdrivers::CGenericSensor;

namespace {

/// One sensor of MRPT in a thread of its own.
class SensorThread {
 public:
  /// Opens the device. \throws Error with file and section, see startSensors().
  /// \param config The content of `file`; gets defaults of ours.
  SensorThread(const std::string& file, const std::string& section, CConfigFileBase& config);
  ~SensorThread();
  SensorThread(const SensorThread&) = delete;
  SensorThread& operator=(const SensorThread&) = delete;

  /// \param events Must outlive this object.
  void start(const SensorEvents& events);

 private:
  void open(CConfigFileBase& config);
  void work(const SensorEvents& events);
  bool process(const SensorEvents& events);
  void tellOdometry(const SensorEvents& events);
  void tellPackets(const SensorEvents& events);
  bool waitUntil(std::chrono::steady_clock::time_point next);

  std::string m_section, m_driver, m_place;  ///< m_place: for messages
  CGenericSensor::Ptr m_sensor;
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

constexpr double kUsualRate = 1000;  // calls of a driver in a second

/// Signals are for the main thread: MRPT takes an interrupted wait for a packet as one that is
/// there.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &m_before);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &m_before, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t m_before;
};

SensorThread::SensorThread(const std::string& file, const std::string& section,
                           CConfigFileBase& config)
    : m_section(section), m_place(file + ": [" + section + "]: ") {
  m_driver = config.read_string(section, "driver", "");
  if (m_driver.empty())
    throw Error(m_place +
                "no driver: name the class of the sensor, such as driver = CVelodyneScanner");
  if (m_driver == "CVelodyneScanner")
    m_sensor = std::make_shared<VelodyneReceiver>();
  else
    m_sensor = CGenericSensor::createSensorPtr(m_driver);
  if (!m_sensor)
    throw Error(m_place + "driver = " + m_driver +
                ": is no sensor that MRPT knows; allowed are the classes of mrpt::hwdrivers, such "
                "as CVelodyneScanner, and COusterScanner, CHesaiScanner, CUdpOdometry");
  try {
    open(config);
  } catch (const std::exception& error) {
    throw Error(m_place + m_driver + ": " + mrptReason(error.what()));
  }
}

SensorThread::~SensorThread() {
  {
    const std::lock_guard lock(m_mutex);
    m_stop = true;
  }
  m_stopping.notify_all();
  if (m_thread.joinable()) m_thread.join();
}

void SensorThread::open(CConfigFileBase& config) {
  if (!config.keyExists(m_section, "process_rate"))
    config.write(m_section, "process_rate", kUsualRate);
  m_receiver = dynamic_cast<const PacketReceiver*>(m_sensor.get());
  m_odometry = dynamic_cast<const CUdpOdometry*>(m_sensor.get());
  m_sensor->loadConfig(config, m_section);
  if (!(m_sensor->getProcessRate() > 0))
    throw Error("process_rate = " + config.read_string(m_section, "process_rate", "") +
                ": allowed is more than 0, in calls a second");
  m_sensor->initialize();
}

void SensorThread::start(const SensorEvents& events) {
  const SignalsBlocked blocked;  // the new thread takes this over
  m_thread = std::thread([this, &events] { work(events); });
}

bool SensorThread::waitUntil(std::chrono::steady_clock::time_point next) {
  std::unique_lock lock(m_mutex);
  return !m_stopping.wait_until(lock, next, [this] { return m_stop; });
}

void SensorThread::work(const SensorEvents& events) {
  using Clock = std::chrono::steady_clock;
  const auto period = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(1 / m_sensor->getProcessRate()));
  try {
    if (m_receiver && m_receiver->source().isOfThisComputerOnly())
      events.warned(
          m_place + m_driver +
          ": listens to this computer only; for a LiDAR in the network set address = 0.0.0.0");
    for (auto next = Clock::now(); waitUntil(next); next = std::max(next + period, Clock::now()))
      if (!process(events)) return events.ended("");
  } catch (const std::exception& error) {
    events.ended(m_place + m_driver + ": " + mrptReason(error.what()));
  }
}

/// \return false at the end of a PCAP file.
bool SensorThread::process(const SensorEvents& events) {
  m_sensor->doProcess();
  if (m_odometry) tellOdometry(events);
  if (m_receiver) tellPackets(events);
  for (const auto& [time, object] : m_sensor->getObservations())
    if (const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object)) {
      ++m_observed;
      events.observed(observation);
    }
  if (!m_receiver || !m_receiver->source().atEnd()) return true;
  if (m_observed == 0)
    throw Error("no whole turn in " + m_receiver->source().pcap() +
                ": the first and the last one are left out, as they may be cut");
  return false;
}

/// Once, as a broken sender would fill the screen.
void SensorThread::tellOdometry(const SensorEvents& events) {
  if (m_warned || !m_odometry->ignored()) return;
  m_warned = true;
  events.warned(m_place + m_driver + ": a packet holds '" + *m_odometry->ignored() +
                "': it is ignored, and so are others that are not x y yaw (m, m, rad), with or "
                "without a Unix time within 10 s of the clock here");
}

/// Warns once of each kind.
void SensorThread::tellPackets(const SensorEvents& events) {
  const auto counts = m_receiver->counts();
  const std::size_t lost = counts.lost - m_told.lost, ignored = counts.ignored - m_told.ignored;
  const std::string place = m_place + m_driver + ": ";
  if (ignored > 0 && m_told.ignored == 0)
    events.warned(place +
                  "a packet is not of this LiDAR, by its size or sender: it is ignored, and so are "
                  "others; of two LiDARs on one port, device_ip says which is meant");
  if (lost > 0 && m_told.lost == 0)
    events.warned(place + "packets are missing, the first before packet " +
                  std::to_string(counts.packets) +
                  ": the network or this computer loses them; scans have gaps");
  if (lost + ignored > 0 && events.counted) events.counted(lost, ignored);
  m_told = counts;
}

class SensorThreads : public LiveSensors {
 public:
  SensorThreads(const std::string& file, SensorEvents events) : m_events(std::move(events)) {
    if (const char* why = io::whyNoInput(file)) throw Error(file + ": cannot be read: " + why);
    std::ifstream in(file);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    if (!in) throw Error(file + ": cannot be read");
    requirePlain(text, file);
    mrpt::config::CConfigFileMemory config(text);
    std::vector<std::string> sections;
    config.getAllSections(sections);
    for (const std::string& section : sections)
      if (!section.empty() && section != "global" &&
          !config.read_bool(section, "rawlog-grabber-ignore", false))
        m_threads.push_back(std::make_unique<SensorThread>(file, section, config));
    if (m_threads.empty())
      throw Error(file + ": names no sensor: add a section with driver = CVelodyneScanner");
    for (const auto& thread : m_threads) thread->start(m_events);
  }

 private:
  SensorEvents m_events;
  std::vector<std::unique_ptr<SensorThread>> m_threads;
};

}  // namespace
}  // namespace polemcl

extern "C" __attribute__((visibility("default"))) polemcl::LiveSensors* polemclStartSensors(
    const std::string& file, polemcl::SensorEvents events) {
  return new polemcl::SensorThreads(file, std::move(events));
}
