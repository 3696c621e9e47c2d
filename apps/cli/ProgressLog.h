#pragma once
/// \file ProgressLog.h
/// \brief Progress of long work where there is no terminal: a line now and then, for logs.

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <thread>

namespace polemcl::apps {

/// \brief Decides when a line is due, and what it says. Knows no clock: times are given.
class ProgressLog {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds interval{30};  ///< longest time without a line

  /// \param label What is being done, such as `batch`. \param total Number of tasks.
  /// \param done Number of tasks that were done before it began.
  ProgressLog(std::string label, std::size_t total, std::size_t done, Time start);

  /// \brief The line that is due: at each further tenth of the tasks, and `interval` after the one
  /// before; such as `batch: 14 of 351 tasks done (4 %), 1 failed, 0:03:20 so far`. Empty when none
  /// is. \param done,failed Tasks that ended well and not.
  std::string line(std::size_t done, std::size_t failed, Time now);
  /// \brief When the next line is due whatever happens.
  Time due() const { return m_last + interval; }

 private:
  std::size_t tenths(std::size_t ended) const { return m_total > 0 ? 10 * ended / m_total : 0; }

  std::string m_label;
  std::size_t m_total, m_tenths;
  Time m_start, m_last;
};

/// \brief Writes the lines of a ProgressLog to stderr, also while one task takes long. On a
/// terminal and where it is to be quiet it writes nothing.
class ProgressLogger {
 public:
  ProgressLogger(const std::string& label, std::size_t total, std::size_t done, bool quiet);
  ~ProgressLogger();
  ProgressLogger(const ProgressLogger&) = delete;
  ProgressLogger& operator=(const ProgressLogger&) = delete;
  /// \brief From any thread.
  void update(std::size_t done, std::size_t failed);

 private:
  void work();
  void write();

  ProgressLog m_log;
  std::size_t m_done, m_failed = 0;
  bool m_ended = false;
  std::mutex m_mutex;
  std::condition_variable m_changed;
  std::thread m_thread;  ///< none where nothing is written
};

}  // namespace polemcl::apps
