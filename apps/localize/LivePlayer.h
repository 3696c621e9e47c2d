#pragma once
/// \file LivePlayer.h
/// \brief The window of a run: shows it as it goes, and again, as its keys say.

#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "localize/Pace.h"
#include "report/scene/LiveMoment.h"
#include "report/scene/LiveScene.h"
#include "report/scene/LiveWindow.h"
#include "report/scene/Playback.h"
#include "report/scene/PlayerKeys.h"
#include "report/scene/ViewOptions.h"

namespace polemcl::apps {

/// \brief What only the reader knows of a scan.
struct WatchedScan {
  std::vector<mrpt::obs::CObservation::Ptr> sources = {};  ///< of its poles, see ReadScan
  std::size_t expected = 0;                                ///< scans of the run; 0: unknown
};

/// \brief Draws in a thread of its own, at most 30 times a second. It never changes the run: that
/// waits in add(), or not at all if it is one of sensors.
class LivePlayer {
 public:
  using OpenWindow = std::function<decltype(report::openLiveWindow)>;

  /// \param map,title As for LiveScene. \throws Error without a display.
  LivePlayer(const report::ViewOptions& options, const std::vector<MapPole>& map,
             const std::string& title, report::Playback::Source source, SequenceOptions reading,
             const OpenWindow& open = report::openLiveWindow);
  /// \brief Closes the window.
  ~LivePlayer();
  LivePlayer(const LivePlayer&) = delete;
  LivePlayer& operator=(const LivePlayer&) = delete;

  /// \brief The run has made this moment. Waits until it may go on, or the window is closed.
  /// \throws Error when something could not be drawn.
  void add(report::LiveMoment moment, const WatchedScan& scan);
  /// \brief There are no more moments.
  void end();
  /// \brief After end(): as RunView::waitForWindow().
  void wait(bool hold);
  bool isOpen() const;
  bool follows() const;

 private:
  struct Picture;
  void work();
  void watch();
  void play();
  Picture picture() const;
  void draw(Picture picture);
  void requireNoFailure() const;

  std::string m_title, m_shownTitle;
  SequenceOptions m_reading;
  report::LiveScene m_scene;
  std::unique_ptr<report::LiveWindow> m_window;

  mutable std::mutex m_mutex;          ///< of all below
  std::condition_variable m_goesOn;    ///< for those that wait in add() and wait()
  std::condition_variable m_stopping;  ///< for the thread
  report::Playback m_playback;
  report::KeptMoments m_kept;
  report::PlayerKeys m_keys;
  Pace m_pace;                                 ///< of what is played
  std::optional<ScanClock::time_point> m_due;  ///< the scan after the one that is shown
  WatchedScan m_newest;
  bool m_changed = false;  ///< the picture is no longer up to date
  bool m_closed = false, m_stop = false;
  std::exception_ptr m_failure;
  std::thread m_thread;  ///< last: it uses all of the above
};

}  // namespace polemcl::apps
