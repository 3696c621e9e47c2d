#include "mrpt/live/LiveQueue.h"

#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <cmath>

#include "io/file/TextFile.h"
#include "mrpt/rawlog/ScanSource.h"

namespace polemcl {

using mrpt::obs::CObservation;

namespace {

constexpr std::chrono::milliseconds kGlance{10};  // between two questions whether the drive goes on

}  // namespace

double SteadyTimes::of(const std::string& sensor, double time, Clock::time_point arrival) {
  const auto [at, isNew] = m_sensors.try_emplace(sensor);
  Sensor& known = at->second;
  const auto after = [&](double start, Clock::time_point begin) {
    return start + std::chrono::duration<double>(arrival - begin).count();
  };
  const double expected = after(known.last, known.arrival);
  const bool goesBack = time + known.offset < known.last - kLatest;
  const bool leaps = goesBack || time + known.offset > expected + kLatest;
  if (!isNew && leaps && std::abs(time - after(m_now, m_at)) <= kLatest) {
    known.offset = 0;
  } else if (!isNew && goesBack) {
    if (std::abs(time + m_offset - expected) > kLatest) m_offset = expected - time;
    known.offset = m_offset;
  }
  m_wentBack = !isNew && time + known.offset < known.last - kLatest;
  known.last = time + known.offset;
  known.arrival = arrival;
  return known.last;
}

double SteadyTimes::offset(const std::string& sensor) const {
  const auto at = m_sensors.find(sensor);
  return at == m_sensors.end() ? 0 : at->second.offset;
}

LiveQueue::LiveQueue(LiveQueueOptions options) : m_options(std::move(options)) {}

/// The time of the observation, which it has then. \param warning Of a clock that was set.
double LiveQueue::steadyTime(CObservation& observation, std::string& warning) {
  const std::string& sensor = observation.sensorLabel;
  const double before = m_times.offset(sensor);
  const double stated = mrpt::Clock::toDouble(observation.timestamp);
  const double time = m_times.of(sensor, stated, Clock::now());
  const double offset = m_times.offset(sensor);
  if (offset != 0) observation.timestamp = mrpt::Clock::fromDouble(time);
  if (m_times.wentBack()) forgetFuture(sensor);
  if (m_times.wentBack() || (offset != before && offset == 0))
    warning = "the times of " + sensor + " are those of this computer again";
  else if (offset != before)
    warning = "the clock of " + sensor + " was set back by " + io::fixed(offset - before, 1) +
              " s: its times go on without that step";
  return time;
}

/// The times of this sensor were ahead.
void LiveQueue::forgetFuture(const std::string& label) {
  m_taken.erase(label);
  const auto isAhead = [&](const Waiting& scan) { return scan.observation->sensorLabel == label; };
  m_scans.erase(std::remove_if(m_scans.begin(), m_scans.end(), isAhead), m_scans.end());
  if (label == m_odometryLabel) m_reached.reset();
}

void LiveQueue::push(const CObservation::Ptr& observation) {
  std::string warning;
  {
    const std::lock_guard lock(m_mutex);
    if (m_ended) return;
    const double time = steadyTime(*observation, warning);
    if (isScan(*observation)) {
      pushScan({time, Clock::now(), observation});
    } else if (dynamic_cast<const mrpt::obs::CObservationOdometry*>(observation.get())) {
      m_odometry.push_back(observation);
      if (m_odometry.size() > kMostReadings) m_odometry.pop_front();
      if (!m_reached) m_odometryLabel = observation->sensorLabel;  // only the first is used
      if (observation->sensorLabel == m_odometryLabel)
        m_reached = std::max(m_reached.value_or(time), time);
    }
  }
  m_changed.notify_one();
  if (!warning.empty() && m_options.warn) m_options.warn(warning);
}

/// Whether scans of this sensor are used; otherwise the drive ends and the failure says why.
bool LiveQueue::isExpected(const std::string& label) {
  if (!m_label) m_label = label;
  const auto& lidars = m_options.lidars;
  const bool isListed = std::find(lidars.begin(), lidars.end(), label) != lidars.end();
  if (lidars.empty() ? label == *m_label : isListed) return true;
  const std::string ignore =
      ", or set rawlog-grabber-ignore = true in its section of the file of the sensors";
  if (lidars.empty())
    endNow("scans of two sensors, " + *m_label + " and " + label +
           ": to fuse them, write lidars = " + *m_label + " " + label + " in [vehicle]" + ignore);
  else
    endNow("scans of the sensor " + label + ", which [vehicle] lidars does not list: add it there" +
           ignore);
  return false;
}

void LiveQueue::pushScan(Waiting scan) {
  const std::string& label = scan.observation->sensorLabel;
  if (!isExpected(label)) return;
  const auto taken = m_taken.find(label);
  if (taken != m_taken.end() && scan.time <= taken->second) {
    ++m_dropped;
    return;
  }
  const auto after =
      std::upper_bound(m_scans.begin(), m_scans.end(), scan.time,
                       [](double time, const Waiting& other) { return time < other.time; });
  m_scans.insert(after, std::move(scan));
  if (m_scans.size() <= m_options.longest * std::max<std::size_t>(1, m_options.lidars.size()))
    return;
  m_scans.pop_front();
  ++m_dropped;
}

void LiveQueue::end(const std::string& failure) {
  {
    const std::lock_guard lock(m_mutex);
    if (!m_ended) endNow(failure);
  }
  m_changed.notify_one();
}

void LiveQueue::stop() {
  {
    const std::lock_guard lock(m_mutex);
    m_ended = true;
    m_scans.clear();
    m_odometry.clear();
  }
  m_changed.notify_one();
}

void LiveQueue::endNow(const std::string& failure) {
  m_ended = true;
  m_failure = failure;
}

std::string LiveQueue::failure() const {
  const std::lock_guard lock(m_mutex);
  return m_failure;
}

std::size_t LiveQueue::dropped() const {
  const std::lock_guard lock(m_mutex);
  return m_dropped;
}

bool LiveQueue::isDue(const Waiting& scan) const {
  return m_ended || (m_reached && *m_reached >= scan.time) ||
         Clock::now() - scan.arrival >= std::chrono::duration<double>(m_options.odometryWait);
}

bool LiveQueue::next(RawlogEntry& entry) {
  entry = RawlogEntry();
  while (!m_options.goesOn || m_options.goesOn()) {
    std::unique_lock lock(m_mutex);
    if (!m_odometry.empty()) {
      entry.observation = std::move(m_odometry.front());
      m_odometry.pop_front();
      return true;
    }
    if (!m_scans.empty() && isDue(m_scans.front())) {
      m_taken[m_scans.front().observation->sensorLabel] = m_scans.front().time;
      entry.arrival = m_scans.front().arrival;
      entry.observation = std::move(m_scans.front().observation);
      m_scans.pop_front();
      return true;
    }
    if (m_ended && m_scans.empty()) return false;
    m_changed.wait_for(lock, kGlance);
  }
  return false;
}

}  // namespace polemcl
