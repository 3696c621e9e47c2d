#include "cli/ProgressLog.h"

#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <utility>

namespace polemcl::apps {
namespace {

using LogClock = std::chrono::steady_clock;

/// "1:02:03" of hours, minutes and seconds.
std::string clockText(LogClock::duration duration) {
  const auto all = std::chrono::duration_cast<std::chrono::seconds>(duration).count();
  char text[64];
  std::snprintf(text, sizeof text, "%lld:%02lld:%02lld", static_cast<long long>(all / 3600),
                static_cast<long long>(all / 60 % 60), static_cast<long long>(all % 60));
  return text;
}

}  // namespace

ProgressLog::ProgressLog(std::string label, std::size_t total, std::size_t done, Time start)
    : m_label(std::move(label)),
      m_total(total),
      m_tenths(tenths(done)),
      m_start(start),
      m_last(start) {}

std::string ProgressLog::line(std::size_t done, std::size_t failed, Time now) {
  const std::size_t reached = tenths(done + failed);
  if (reached <= m_tenths && now < due()) return {};
  m_tenths = reached;
  m_last = now;
  std::string text =
      m_label + ": " + std::to_string(done) + " of " + std::to_string(m_total) + " tasks done";
  if (m_total > 0) text += " (" + std::to_string(100 * done / m_total) + " %)";
  if (failed > 0) text += ", " + std::to_string(failed) + " failed";
  return text + ", " + clockText(now - m_start) + " so far";
}

ProgressLogger::ProgressLogger(const std::string& label, std::size_t total, std::size_t done,
                               bool quiet)
    : m_log(label, total, done, LogClock::now()), m_done(done) {
  if (!quiet && ::isatty(STDERR_FILENO) == 0) m_thread = std::thread([this] { work(); });
}

ProgressLogger::~ProgressLogger() {
  if (!m_thread.joinable()) return;
  {
    const std::lock_guard lock(m_mutex);
    m_ended = true;
  }
  m_changed.notify_all();
  m_thread.join();
}

void ProgressLogger::update(std::size_t done, std::size_t failed) {
  if (!m_thread.joinable()) return;
  const std::lock_guard lock(m_mutex);
  m_done = done;
  m_failed = failed;
  write();
}

void ProgressLogger::work() {
  std::unique_lock lock(m_mutex);
  while (!m_changed.wait_until(lock, m_log.due(), [this] { return m_ended; })) write();
}

void ProgressLogger::write() {
  const std::string line = m_log.line(m_done, m_failed, LogClock::now());
  if (!line.empty()) std::cerr << line + '\n' << std::flush;
}

}  // namespace polemcl::apps
