#pragma once
/// \file Progress.h
/// \brief Progress on stderr: a bar on a terminal, a line now and then elsewhere.

#include <chrono>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>

namespace polemcl::apps {

/// \brief Time since then, s.
inline double secondsSince(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// \brief Shows `label  done/total  rate  time left` on one line that rewrites itself. Without a
/// terminal, it writes such a line without the bar after each `interval`, for logs.
class Progress {
 public:
  static constexpr std::chrono::seconds interval{30};

  /// \param label What is being done, such as `extract`.
  /// \param total Number of steps, 0 when not known in advance.
  /// \param quiet True: nothing is shown.
  /// \param every Time between lines where there is no terminal.
  Progress(std::string label, std::size_t total, bool quiet, std::chrono::seconds every = interval);
  /// \brief Takes the bar off the screen.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// \brief `done` steps are finished. Cheap: redraws at most ten times a second. Fewer than before
  /// begin another stretch of work, whose rate counts from then on.
  void update(std::size_t done);
  /// \brief The same where the total becomes known on the way.
  void update(std::size_t done, std::size_t total);
  /// \brief update() as a function, for as long as this object lives.
  std::function<void(std::size_t, std::size_t)> updates() {
    return [this](std::size_t done, std::size_t total) { update(done, total); };
  }
  /// \brief One more step is finished; from any thread.
  void step();
  /// \brief A line of its own on stderr, quiet or not; the bar, if there is one, comes again after
  /// it.
  void say(const std::string& line);

 private:
  using Clock = std::chrono::steady_clock;
  void draw(double seconds);

  std::string m_label;
  std::size_t m_total, m_done = 0;
  bool m_shown, m_terminal;
  bool m_drawn = false;
  std::chrono::seconds m_every;
  Clock::time_point m_start, m_last;
  std::mutex m_mutex;  ///< of step()
};

/// \brief The text of the bar.
/// \param seconds Since the start.
/// \param width Length of the bar, characters; 0: as in a log, `extract 25/100 (25 %)  12.5/s …`.
/// \return Such as `extract [#####---------------] 25/100  12.5/s  0:06 left`. Without `total` no
///         bar and no time left; no rate before the first step or before any time has passed.
std::string progressLine(const std::string& label, std::size_t done, std::size_t total,
                         double seconds, std::size_t width = 20);

}  // namespace polemcl::apps
