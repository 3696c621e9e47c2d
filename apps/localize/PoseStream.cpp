#include "localize/PoseStream.h"

#include <csignal>
#include <iostream>

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

PoseStream::PoseStream(const std::filesystem::path& target)
    : m_target(target),
      m_out(target == "-" ? std::cout : m_file),
      m_last(lineOf(0, LocalizationUpdate(), 0)) {
  std::signal(SIGPIPE, SIG_IGN);
  if (target != "-") m_file.open(target, std::ios::trunc);
  if (!m_out) throw Error(target.string() + ": cannot be created for --stream");
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

void PoseStream::write(const nlohmann::ordered_json& line) {
  if (!m_failure.empty()) return;
  m_out << line.dump() << std::endl;
  if (!m_out)
    m_failure = (m_target == "-" ? "standard output" : m_target.string()) +
                ": cannot be written by --stream";
}

}  // namespace polemcl::apps
