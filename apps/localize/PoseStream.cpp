#include "localize/PoseStream.h"

#include <ext/stdio_filebuf.h>

#include <fcntl.h>
#include <poll.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <iostream>
#include <thread>

#include "cli/Messages.h"
#include "localize/LocalizeReport.h"

namespace polemcl::apps {
namespace {

nlohmann::ordered_json lineOf(std::size_t scan, const LocalizationUpdate& update,
                              std::size_t dropped) {
  nlohmann::ordered_json line{{"scan", scan},   {"time", update.time}, {"x_m", nullptr},
                              {"y_m", nullptr}, {"yaw_rad", nullptr},  {"covariance", nullptr}};
  if (update.estimate) {
    const auto& [mean, C] = *update.estimate;
    line["x_m"] = mean.x;
    line["y_m"] = mean.y;
    line["yaw_rad"] = mean.yaw;
    line["covariance"] = {C(0, 0), C(0, 1), C(0, 2), C(1, 1), C(1, 2), C(2, 2)};
  }
  const Health& health = update.health;
  line["state"] = name(health.state);
  line["reason"] = name(health.reason);
  line["matched_share"] = health.matchedShare;
  line["spread_m"] = health.spread;
  line["poles"] = update.poles;
  line["relocalized"] = update.relocalized;
  line["odometry_scale"] = update.odometryErrors.scale;
  line["odometry_yaw_rad_m"] = update.odometryErrors.yaw;
  line["dropped"] = dropped;
  return line;
}

}  // namespace

PoseStream::PoseStream(const std::filesystem::path& target, std::function<bool()> goesOn)
    : m_target(target),
      m_goesOn(std::move(goesOn)),
      m_out(std::cout.rdbuf()),
      m_last(lineOf(0, LocalizationUpdate(), 0)) {
  std::signal(SIGPIPE, SIG_IGN);
  if (target == "-") return;
  m_descriptor = opened();
  m_file = std::make_unique<__gnu_cxx::stdio_filebuf<char>>(m_descriptor, std::ios::out);
  m_out.rdbuf(m_file.get());
}

PoseStream::~PoseStream() = default;

/// A FIFO cannot be opened before somebody reads it.
int PoseStream::opened() const {
  const std::string name = m_target.string();
  std::error_code none;
  const bool isPipe = std::filesystem::is_fifo(m_target, none);
  constexpr int kSilent = 50;  // waits before it is told: a second
  for (int waits = 0;; ++waits) {
    const int descriptor =
        open(name.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK, 0666);
    if (descriptor >= 0) {
      fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
      return descriptor;
    }
    if (!isPipe || errno != ENXIO) throw Error(name + ": cannot be created for --stream");
    if (m_goesOn && !m_goesOn()) throw Error(name + ": nobody reads it");
    if (waits == kSilent)
      std::cerr << warningLine("pole-localize", name + ": waits for a reader") << '\n';
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

void PoseStream::add(std::size_t scan, const LocalizationUpdate& update, std::size_t dropped) {
  const std::lock_guard lock(m_mutex);
  m_last = lineOf(scan, update, dropped);
  write(m_last);
}

void PoseStream::addGap() {
  const std::lock_guard lock(m_mutex);
  nlohmann::ordered_json line = m_last;
  for (const char* const key : {"scan", "time", "x_m", "y_m", "yaw_rad", "covariance",
                                "matched_share", "spread_m", "poles"})
    line[key] = nullptr;
  const bool wasLost = line["state"] == name(HealthState::lost);
  line["state"] = name(wasLost ? HealthState::lost : HealthState::degraded);
  line["reason"] = name(HealthReason::timeGap);
  line["relocalized"] = false;
  write(line);
}

std::string PoseStream::failure() const {
  const std::lock_guard lock(m_mutex);
  return m_failure;
}

/// \return Whether a line can be written at once: a pipe then takes 4096 bytes.
bool PoseStream::waitForReader() const {
  constexpr int kGlance = 50;  // ms, between two questions whether the work goes on
  pollfd target{m_descriptor, POLLOUT, 0};
  while (poll(&target, 1, kGlance) <= 0)
    if (m_goesOn && !m_goesOn()) return false;
  return true;
}

void PoseStream::write(const nlohmann::ordered_json& line) {
  if (!m_failure.empty()) return;
  const std::string name = m_target == "-" ? "standard output" : m_target.string();
  if (!waitForReader())
    m_failure = name + ": was not read any more, the last lines of --stream are missing";
  else if (!(m_out << line.dump() << std::endl))
    m_failure = name + ": cannot be written by --stream";
}

}  // namespace polemcl::apps
