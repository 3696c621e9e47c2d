#include "localize/Pace.h"

#include <algorithm>
#include <thread>
#include <utility>

namespace polemcl::apps {
namespace {

constexpr double farAway = 1e8;  // s; the clock can count to 9e9

}  // namespace

Pace::Pace(std::optional<double> rate, std::function<bool()> goesOn)
    : m_rate(rate), m_goesOn(std::move(goesOn)) {}

ScanClock::time_point Pace::dueOf(double time) {
  if (m_rate && m_time) {
    const std::chrono::duration<double> gap(
        std::min(std::clamp(time - *m_time, 0.0, longestGap) / *m_rate, farAway));
    m_due += std::chrono::duration_cast<ScanClock::duration>(gap);
  } else {
    m_due = ScanClock::now();
  }
  m_time = time;
  return m_due;
}

ScanClock::time_point Pace::waitFor(double time, const std::function<bool()>& work) {
  const auto goesOn = [&] { return m_rate && (!m_goesOn || m_goesOn()) && (!work || work()); };
  if (!goesOn()) {
    restart();
    return ScanClock::now();
  }
  dueOf(time);
  // In short pieces: a window that is closed, or an error elsewhere, ends the waiting.
  while (ScanClock::now() < m_due && goesOn())
    std::this_thread::sleep_for(
        std::min<ScanClock::duration>(m_due - ScanClock::now(), std::chrono::milliseconds(50)));
  return std::min(m_due, ScanClock::now());
}

}  // namespace polemcl::apps
