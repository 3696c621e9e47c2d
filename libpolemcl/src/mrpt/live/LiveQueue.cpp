#include "mrpt/live/LiveQueue.h"

#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>

#include "mrpt/rawlog/ScanSource.h"

namespace polemcl {

using mrpt::obs::CObservation;

namespace {

constexpr std::chrono::milliseconds glance{10};  // between two questions whether the drive goes on

}  // namespace

LiveQueue::LiveQueue(LiveQueueOptions options) : m_options(std::move(options)) {}

void LiveQueue::push(const CObservation::Ptr& observation) {
  const double time = mrpt::Clock::toDouble(observation->timestamp);
  {
    const std::lock_guard lock(m_mutex);
    if (m_ended) return;
    if (isScan(*observation)) {
      pushScan({time, Clock::now(), observation});
    } else if (dynamic_cast<const mrpt::obs::CObservationOdometry*>(observation.get())) {
      m_odometry.push_back(observation);
      m_reached = std::max(m_reached.value_or(time), time);
    }
  }
  m_changed.notify_one();
}

void LiveQueue::pushScan(Waiting scan) {
  const std::string& label = scan.observation->sensorLabel;
  if (!m_label) m_label = label;
  if (label != *m_label)
    return endNow("scans of two sensors, " + *m_label + " and " + label +
                  ": poles are extracted from one; set rawlog-grabber-ignore = true in the section "
                  "of the other");
  if (m_taken && scan.time <= *m_taken) {
    ++m_dropped;
    return;
  }
  const auto after =
      std::upper_bound(m_scans.begin(), m_scans.end(), scan.time,
                       [](double time, const Waiting& other) { return time < other.time; });
  m_scans.insert(after, std::move(scan));
  if (m_scans.size() <= m_options.longest) return;
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
  std::unique_lock lock(m_mutex);
  for (;; m_changed.wait_for(lock, glance)) {
    if (m_options.goesOn && !m_options.goesOn()) return false;
    if (!m_odometry.empty()) {
      entry.observation = std::move(m_odometry.front());
      m_odometry.pop_front();
      return true;
    }
    if (!m_scans.empty() && isDue(m_scans.front())) {
      m_taken = m_scans.front().time;
      entry.arrival = m_scans.front().arrival;
      entry.observation = std::move(m_scans.front().observation);
      m_scans.pop_front();
      return true;
    }
    if (m_ended && m_scans.empty()) return false;
  }
}

}  // namespace polemcl
