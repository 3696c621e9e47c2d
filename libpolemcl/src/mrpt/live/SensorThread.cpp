#include "mrpt/live/SensorThread.h"

#include <pthread.h>

#include <csignal>

#include <polemcl/core/common/Types.h>
#include "mrpt/common/MrptReason.h"
#include "mrpt/live/VelodyneReceiver.h"

namespace polemcl {

using mrpt::config::CConfigFileBase;
using mrpt::hwdrivers::CGenericSensor;

namespace {

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

}  // namespace

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

}  // namespace polemcl
