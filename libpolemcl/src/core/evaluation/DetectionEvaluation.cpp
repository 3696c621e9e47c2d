#include "core/evaluation/DetectionEvaluation.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <unordered_map>

#include "core/common/GreedyAssignment.h"
#include "core/common/Statistics.h"
#include "core/common/Transform.h"

namespace polemcl {
namespace {

std::optional<double> mean(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::optional<double> share(std::size_t part, std::size_t all) {
  if (all == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(all);
}

/// Chance that a value of `high` is above one of `low`, equal ones counting half.
std::optional<double> areaUnderRoc(const std::vector<double>& high, std::vector<double> low) {
  if (high.empty() || low.empty()) return std::nullopt;
  std::sort(low.begin(), low.end());
  double above = 0;
  for (const double value : high) {
    const auto [first, last] = std::equal_range(low.begin(), low.end(), value);
    above += 0.5 * static_cast<double>((first - low.begin()) + (last - low.begin()));
  }
  return above / static_cast<double>(high.size()) / static_cast<double>(low.size());
}

}  // namespace

DetectionEvaluation::DetectionEvaluation(double radius) : m_radius(radius) {
  greedyAssignment({}, {}, radius);  // refuses a radius that makes no sense
}

void DetectionEvaluation::addRight(const PoleDetection& detection, const TruePoleInScan& truth) {
  const Eigen::Vector2d error(detection.x - truth.x, detection.y - truth.y);
  const Eigen::LLT<Eigen::Matrix2d> cholesky(detection.covariance);
  if (cholesky.info() != Eigen::Success)
    throw Error("the pole at " + std::to_string(detection.x) + ", " + std::to_string(detection.y) +
                " has a covariance that is not positive definite");
  m_centre.push_back(error.norm());
  m_radiusError.push_back(detection.radius - truth.radius);
  m_nees.push_back(error.dot(cholesky.solve(error)));
  const double range = std::hypot(truth.x, truth.y);
  if (range == 0) return;  // no ray
  const Eigen::Vector2d ray(truth.x / range, truth.y / range), left(-ray.y(), ray.x());
  m_along.push_back(error.dot(ray));
  m_across.push_back(error.dot(left));
}

void DetectionEvaluation::add(const std::vector<PoleDetection>& detections,
                              const std::vector<TruePoleInScan>& truth) {
  std::vector<char> right(detections.size(), 0);
  for (const AssignedPair& pair :
       greedyAssignment(centresOf(detections), centresOf(truth), m_radius)) {
    right[pair.first] = 1;
    m_found += truth[pair.second].visible;
    addRight(detections[pair.first], truth[pair.second]);
  }
  for (std::size_t i = 0; i < detections.size(); ++i)
    (right[i] ? m_rightConfidence : m_wrongConfidence).push_back(detections[i].confidence);
  for (const TruePoleInScan& pole : truth) m_visible += pole.visible;
  ++m_scans;
}

DetectionScore DetectionEvaluation::score() const {
  DetectionScore score;
  score.scans = m_scans;
  score.right = m_rightConfidence.size();
  score.detections = score.right + m_wrongConfidence.size();
  score.visible = m_visible;
  score.found = m_found;
  score.precision = share(score.right, score.detections);
  score.recall = share(score.found, score.visible);
  score.centreMean = mean(m_centre);
  score.centreMedian = quantile(m_centre, 0.5);
  score.centre90 = quantile(m_centre, 0.9);
  score.radiusMean = mean(m_radiusError);
  std::vector<double> absolute = m_radiusError;
  for (double& error : absolute) error = std::abs(error);
  score.radiusMedian = quantile(absolute, 0.5);
  score.neesMean = mean(m_nees);
  score.neesMedian = quantile(m_nees, 0.5);
  score.biasAlong = mean(m_along);
  score.biasAcross = mean(m_across);
  score.auc = areaUnderRoc(m_rightConfidence, m_wrongConfidence);
  return score;
}

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
