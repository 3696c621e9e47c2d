#include "cli/Progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <utility>

#include "cli/Messages.h"

namespace polemcl::apps {

Progress::Progress(std::string label, std::size_t total, bool quiet, std::chrono::seconds every)
    : m_label(std::move(label)),
      m_total(total),
      m_shown(!quiet),
      m_terminal(errorsAreOnTerminal()),
      m_every(every),
      m_start(Clock::now()),
      m_last(m_start) {}

Progress::~Progress() {
  if (m_drawn) std::cerr << "\r\033[K" << std::flush;
}

void Progress::update(std::size_t done, std::size_t total) {
  m_total = total;
  update(done);
}

void Progress::update(std::size_t done) {
  if (!m_shown) return;
  const auto now = Clock::now();
  if (done < m_done) m_start = now;
  m_done = done;
  if (!m_terminal && now - m_last < m_every) return;
  if (m_drawn && now - m_last < std::chrono::milliseconds(100)) return;
  m_last = now;
  draw(std::chrono::duration<double>(now - m_start).count());
}

void Progress::draw(double seconds) {
  m_drawn = m_terminal;
  if (m_terminal)
    std::cerr << '\r' << progressLine(m_label, m_done, m_total, seconds) << "\033[K" << std::flush;
  else
    std::cerr << progressLine(m_label, m_done, m_total, seconds, 0) + '\n' << std::flush;
}

void Progress::step() {
  const std::lock_guard lock(m_mutex);
  update(m_done + 1);
}

void Progress::say(const std::string& line) {
  std::cerr << (m_drawn ? "\r\033[K" : "") << line << std::endl;
  m_drawn = false;
}

std::string progressLine(const std::string& label, std::size_t done, std::size_t total,
                         double seconds, std::size_t width) {
  std::string line = label + ' ';
  if (total > 0 && width > 0) {
    const std::size_t filled = std::min(done, total) * width / total;
    line += '[' + coloured(Colour::green, std::string(filled, '#')) +
            std::string(width - filled, '-') + "] ";
  }
  line += std::to_string(done);
  if (total > 0) line += '/' + std::to_string(total);
  if (total > 0 && width == 0) line += " (" + std::to_string(100 * done / total) + " %)";
  if (done == 0 || seconds <= 0) return line;

  const double rate = static_cast<double>(done) / seconds;
  char text[64];
  std::snprintf(text, sizeof text, "  %.1f/s", rate);
  line += text;
  if (total > done) {
    const auto left = static_cast<long>(std::lround(static_cast<double>(total - done) / rate));
    std::snprintf(text, sizeof text, "  %ld:%02ld left", left / 60, left % 60);
    line += text;
  }
  return line;
}

}  // namespace polemcl::apps
