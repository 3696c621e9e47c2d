#include "report/scene/Playback.h"

#include <algorithm>
#include <utility>

namespace polemcl::report {

void Playback::add(double elapsed, HealthState state) {
  const bool shown = !isEmpty() && isPlaying() && m_position == newest();
  m_scans.push_back({elapsed, state});
  if (m_sought ? m_sought() : shown && m_source == Source::sensors) show(newest());
}

void Playback::end() {
  m_ended = true;
  if (!isSeeking() || isEmpty()) return;
  m_paused = true;
  show(newest());
}

void Playback::forget(std::size_t oldest) {
  m_oldest = oldest;
  m_position = std::max(m_position, oldest);
}

void Playback::show(std::size_t scan) {
  m_sought = nullptr;
  m_position = std::max(scan, m_oldest);
}

void Playback::seek(std::function<bool()> isFound) {
  m_sought = std::move(isFound);
  if (m_ended) end();
}

void Playback::togglePause() {
  if (isEmpty()) return;
  if (isSeeking()) {
    show(newest());
    m_paused = true;
  } else {
    m_paused = !m_paused;
  }
}

void Playback::step(std::ptrdiff_t scans) {
  if (isEmpty()) return;
  m_paused = true;
  const auto wanted = static_cast<std::ptrdiff_t>(m_position) + scans;
  const auto scan = static_cast<std::size_t>(std::max<std::ptrdiff_t>(wanted, 0));
  if (scan <= newest())
    show(scan);
  else
    seek([this, scan] { return newest() >= scan; });
}

void Playback::skip(double seconds) {
  if (!isEmpty()) goTo(elapsed(m_position) + seconds);
}

void Playback::goTo(double elapsed) {
  if (isEmpty()) return;
  const auto found = std::lower_bound(m_scans.begin(), m_scans.end(), elapsed,
                                      [](const Scan& scan, double t) { return scan.elapsed < t; });
  if (found != m_scans.end())
    show(static_cast<std::size_t>(found - m_scans.begin()));
  else
    seek([this, elapsed] { return m_scans.back().elapsed >= elapsed; });
}

void Playback::toFirst() {
  if (!isEmpty()) show(m_oldest);
}

void Playback::toNewest() {
  if (!isEmpty()) show(newest());
}

bool Playback::startsTrouble(std::size_t scan) const {
  const HealthState before = scan > 0 ? m_scans[scan - 1].state : HealthState::ok;
  return m_scans[scan].state != HealthState::ok && m_scans[scan].state != before;
}

void Playback::toNextTrouble() {
  if (isEmpty()) return;
  m_paused = true;
  for (std::size_t scan = m_position + 1; scan <= newest(); ++scan)
    if (startsTrouble(scan)) return show(scan);
  seek([this] { return startsTrouble(newest()); });
}

void Playback::toPreviousTrouble() {
  if (isEmpty()) return;
  for (std::size_t scan = m_position; scan-- > m_oldest;)
    if (startsTrouble(scan)) {
      m_paused = true;
      return show(scan);
    }
}

void Playback::advance() {
  if (canAdvance()) ++m_position;
}

bool Playback::wantsMore() const {
  if (m_source == Source::sensors || isEmpty() || isSeeking()) return true;
  return !m_paused && m_position == newest();
}

}  // namespace polemcl::report
