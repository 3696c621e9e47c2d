#include "localize/LivePlayer.h"

#include <utility>

#include "cli/Progress.h"
#include "report/scene/LiveMoment.h"
#include "report/scene/PlayerPanels.h"

namespace polemcl::apps {

/// What is drawn, copied: the run goes on meanwhile.
struct LivePlayer::Picture {
  report::LiveMoment moment;
  report::TimeLine line;
  std::string words, title;
  std::vector<std::string> help;
  std::vector<mrpt::obs::CObservation::Ptr> sources;  ///< of the points to be shown
};

LivePlayer::LivePlayer(const report::ViewOptions& options, const std::vector<MapPole>& map,
                       const std::string& title, report::Playback::Source source,
                       SequenceOptions reading, const OpenWindow& open)
    : m_title("pole-localize: " + title),
      m_reading(std::move(reading)),
      m_scene(map, title),
      m_window(open(m_title, static_cast<unsigned>(options.width),
                    static_cast<unsigned>(options.height), m_scene.scene())),
      m_playback(source),
      m_pace(report::parseRate(options.rate)) {
  m_thread = std::thread([this] { work(); });
}

LivePlayer::~LivePlayer() {
  {
    const std::lock_guard lock(m_mutex);
    m_stop = true;
    m_stopping.notify_all();
  }
  m_thread.join();
}

bool LivePlayer::isOpen() const {
  return m_window->isOpen();
}

bool LivePlayer::follows() const {
  const std::lock_guard lock(m_mutex);
  return m_playback.isEmpty() || m_playback.follows();
}

void LivePlayer::requireNoFailure() const {
  if (m_failure) std::rethrow_exception(m_failure);
}

void LivePlayer::add(report::LiveMoment moment, const WatchedScan& scan) {
  std::unique_lock lock(m_mutex);
  requireNoFailure();
  m_playback.add(moment.elapsed, moment.health.state);
  m_kept.add(std::move(moment));
  m_playback.forget(m_kept.oldest());
  m_newest = scan;
  m_changed = true;
  play();  // at full speed the run does not wait for the other thread
  m_goesOn.wait(lock, [&] { return m_closed || m_playback.wantsMore(); });
  requireNoFailure();
}

void LivePlayer::end() {
  const std::lock_guard lock(m_mutex);
  m_playback.end();
  m_newest.expected = 0;  // the newest is the last
  m_changed = true;
}

void LivePlayer::wait(bool hold) {
  std::unique_lock lock(m_mutex);
  m_goesOn.wait(lock, [&] { return m_closed || (!hold && m_playback.isOver()); });
  requireNoFailure();
}

/// Shows the scans that are due, one after the other.
void LivePlayer::play() {
  if (!m_playback.follows() && !m_playback.canAdvance()) m_pace.restart(), m_due.reset();
  while (m_playback.canAdvance()) {
    if (!m_due) m_due = m_pace.dueOf(m_playback.elapsed(m_playback.position() + 1));
    if (ScanClock::now() < *m_due) return;
    m_playback.advance();
    m_due.reset();
    m_changed = true;
  }
}

void LivePlayer::work() {
  try {
    watch();
  } catch (...) {
    const std::lock_guard lock(m_mutex);
    m_failure = std::current_exception();
  }
  const std::lock_guard lock(m_mutex);
  m_closed = true;
  m_goesOn.notify_all();
}

void LivePlayer::watch() {
  constexpr double leastSeconds = 1.0 / 30;  // more often the eye sees nothing new
  constexpr std::chrono::milliseconds look(10);
  ScanClock::time_point drawn;
  std::unique_lock lock(m_mutex);
  while (!m_stop && m_window->isOpen()) {
    for (const report::KeyPress& key : m_window->takeKeys()) {
      m_keys.take(key, m_playback);
      m_pace.restart();
      m_due.reset();
      m_changed = true;
    }
    play();
    m_goesOn.notify_all();
    if (m_changed && !m_playback.isEmpty() && secondsSince(drawn) >= leastSeconds) {
      drawn = ScanClock::now();
      m_changed = false;
      Picture next = picture();
      lock.unlock();
      draw(std::move(next));
      lock.lock();
    }
    const auto wake = ScanClock::now() + look;
    m_stopping.wait_until(lock, m_due ? std::min(*m_due, wake) : wake, [&] { return m_stop; });
  }
}

LivePlayer::Picture LivePlayer::picture() const {
  Picture next;
  const std::size_t position = m_playback.position();
  next.moment = m_kept.at(position);
  next.line = report::makeTimeLine(m_playback, m_kept.errors(), m_newest.expected);
  next.words = report::describe(m_playback, m_newest.expected);
  if (!m_keys.typed().empty()) next.words += ", go to " + m_keys.typed() + " s: enter";
  const bool still = m_playback.isPaused() || m_playback.isSeeking();
  next.title = still ? m_title + ": " + next.words : m_title;
  if (m_keys.showsHelp()) next.help = report::keyHelp();
  if (m_keys.showsPoints() && position == m_playback.newest()) next.sources = m_newest.sources;
  return next;
}

void LivePlayer::draw(Picture picture) {
  picture.moment.points_robot = report::scanPoints(picture.sources, m_reading);
  m_window->update(
      [&] {
        m_scene.show(picture.moment);
        report::showTimeLine(*m_scene.scene(), picture.line, picture.words);
        report::showKeys(*m_scene.scene(), picture.help, picture.line.limit > 0);
      },
      m_scene.camera());
  if (picture.title != m_shownTitle) m_window->setTitle(picture.title);
  m_shownTitle = std::move(picture.title);
}

}  // namespace polemcl::apps
