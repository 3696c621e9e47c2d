#pragma once
/// \file Playback.h
/// \brief Which scan of a run is shown, and whether the run may go on: a player without a window.

#include <cstddef>
#include <functional>
#include <vector>

#include <polemcl/core/localization/LocalizationUpdate.h>

namespace polemcl::report {

/// \brief The position in a run that is being made. Scans are counted from 0.
///
/// A run of a rawlog waits for the player: it goes on while the newest scan is shown and nothing is
/// paused, or while a scan ahead is sought. Sensors do not wait: their run goes on always. The
/// position then stays with the newest scan until somebody pauses or goes back.
class Playback {
 public:
  enum class Source { rawlog, sensors };
  explicit Playback(Source source) : m_source(source) {}
  Playback(const Playback&) = delete;
  Playback& operator=(const Playback&) = delete;

  /// \brief The run has made one more scan. \param elapsed Time since the first scan, s; not less
  /// than that of the scan before.
  void add(double elapsed, HealthState state);
  /// \brief The run is over. What is still sought is given up: the last scan is shown, paused.
  void end();
  /// \brief Scans before this one can no longer be shown.
  void forget(std::size_t oldest);

  /// \name What the user asks for, from the position. A scan ahead of the newest is sought.
  /// @{
  /// \brief Pauses or plays on; ends a search for a scan.
  void togglePause();
  void step(std::ptrdiff_t scans);  ///< pauses there
  void skip(double seconds);
  void goTo(double elapsed);  ///< the first scan not before this time, s
  void toFirst();
  void toNewest();
  /// \brief Where the next stretch of `degraded` or of `lost` begins; pauses there.
  void toNextTrouble();
  void toPreviousTrouble();  ///< nothing where no such stretch begins before
  /// @}

  /// \brief Shows the next scan, if it is there. To be called when that scan is due.
  void advance();

  bool isEmpty() const { return m_scans.empty(); }
  std::size_t position() const { return m_position; }
  std::size_t newest() const { return m_scans.size() - 1; }
  double elapsed(std::size_t scan) const { return m_scans[scan].elapsed; }
  HealthState state(std::size_t scan) const { return m_scans[scan].state; }
  bool isPaused() const { return m_paused; }
  bool isSeeking() const { return static_cast<bool>(m_sought); }
  /// \brief Scans are shown one after the other, and the next one is there.
  bool canAdvance() const { return isPlaying() && m_position < newest(); }
  /// \brief As the run gives them, not paused and not somewhere before.
  bool follows() const { return isPlaying() && m_position + 1 >= newest(); }
  /// \brief The run is to make its next scan.
  bool wantsMore() const;
  bool hasEnded() const { return m_ended; }
  /// \brief The run is over, and its last scan has been played.
  bool isOver() const { return m_ended && isPlaying() && m_position == newest(); }

 private:
  struct Scan {
    double elapsed = 0;  ///< s
    HealthState state = HealthState::ok;
  };
  bool isPlaying() const { return !isEmpty() && !m_paused && !isSeeking(); }
  bool startsTrouble(std::size_t scan) const;
  void show(std::size_t scan);
  void seek(std::function<bool()> isFound);

  Source m_source;
  std::vector<Scan> m_scans;
  std::size_t m_position = 0, m_oldest = 0;
  bool m_paused = false, m_ended = false;
  std::function<bool()> m_sought;  ///< the newest scan is the one that is sought
};

}  // namespace polemcl::report
