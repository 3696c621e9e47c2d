#include "core/evaluation/PoleVisibility.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>

namespace polemcl {
std::vector<PoleSight> sightPoles(const PointsView& points,
                                  const std::vector<std::uint32_t>& labels,
                                  const Eigen::Isometry3d& T_map_cloud,
                                  const std::vector<WorldPole>& poles, const VisibilityRule& rule) {
  if (labels.size() != points.size)
    throw Error(std::to_string(labels.size()) + " labels for " + std::to_string(points.size) +
                " points; there must be one for each");
  std::unordered_map<std::uint32_t, std::size_t> indexOf;
  for (std::size_t i = 0; i < poles.size(); ++i)
    if (!indexOf.emplace(poles[i].id, i).second)
      throw Error("two poles have the id " + std::to_string(poles[i].id));
  std::vector<std::vector<double>> heights(poles.size());
  const Eigen::RowVector3d up = T_map_cloud.linear().row(2);
  const Eigen::Vector3d sensor = T_map_cloud.translation();
  for (std::size_t i = 0; i < points.size; ++i) {
    const auto pole = indexOf.find(labels[i]);
    if (pole == indexOf.end()) continue;
    const Eigen::Vector3d point(points.x[i], points.y[i], points.z[i]);
    heights[pole->second].push_back(up.dot(point) + sensor.z());
  }
  std::vector<PoleSight> sights(poles.size());
  for (std::size_t i = 0; i < poles.size(); ++i) {
    PoleSight& sight = sights[i];
    const auto& z = heights[i];
    sight.returns = z.size();
    sight.range = std::hypot(poles[i].x - sensor.x(), poles[i].y - sensor.y());
    sight.sensor = sensor.z();
    sight.lowest = z.empty() ? sensor.z() : *std::min_element(z.begin(), z.end());
    sight.highest = z.empty() ? sensor.z() : *std::max_element(z.begin(), z.end());
    sight.visible = sight.returns >= rule.returns && sight.highest - sight.lowest >= rule.height &&
                    sight.range <= rule.range;
  }
  return sights;
}

std::vector<TruePoleInScan> polesInScan(const std::vector<WorldPole>& poles,
                                        const std::vector<PoleSight>& sights,
                                        const Eigen::Isometry3d& T_scan_map) {
  std::vector<TruePoleInScan> result;
  for (std::size_t i = 0; i < poles.size(); ++i) {
    const Eigen::Vector3d p =
        T_scan_map * Eigen::Vector3d(poles[i].x, poles[i].y, sights[i].sensor);
    result.push_back({p.x(), p.y(), poles[i].radius, sights[i].visible});
  }
  return result;
}

}  // namespace polemcl
