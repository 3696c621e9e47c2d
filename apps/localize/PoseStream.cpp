#include "localize/PoseStream.h"

#include <iostream>
#include <nlohmann/json.hpp>

#include "localize/LocalizeReport.h"

namespace polemcl::apps {

PoseStream::PoseStream(const std::filesystem::path& target)
    : m_target(target), m_out(target == "-" ? std::cout : m_file) {
  if (target != "-") m_file.open(target, std::ios::trunc);
  if (!m_out) throw Error(target.string() + ": cannot be created for --stream");
}

void PoseStream::add(std::size_t scan, const LocalizationUpdate& update, std::size_t dropped) {
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
  m_out << line.dump() << std::endl;
  if (!m_out) throw Error(m_target.string() + ": cannot be written by --stream");
}

}  // namespace polemcl::apps
