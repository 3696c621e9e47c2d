#include "core/global_localization/Constellation.h"

#include <algorithm>
#include <cmath>

#include "core/common/Transform.h"

namespace polemcl {
namespace {

constexpr double s_pathStep = 4;            ///< m
constexpr std::size_t s_mostReliable = 80;  ///< the best seen; more would only cost time
constexpr std::size_t s_mostQueryPoles = 300;

/// Odds that a pole with this number of hits stands on the map. One hit more halves the doubt
/// whether it is a pole at all, less the more chances it missed.
double oddsOf(const SubmapPole& pole, const GlobalOptions& options) {
  if (pole.hits < static_cast<std::uint32_t>(options.minHits)) return 0;
  const double real = 1 - std::pow(0.5, std::min<double>(pole.hits, 30));
  const double p = options.mapped * real;
  return p / (1 - p);
}

}  // namespace

Constellation::Constellation(const LocalSubmap& submap, const GlobalOptions& options,
                             const std::optional<SearchArea>& area)
    : m_area(area), m_scale(submap.options().scale) {
  const Pose2D& pose = submap.pose();
  const Eigen::Vector2d here(pose.x, pose.y);
  const Eigen::Matrix2d rotation = rotationOf(-pose.yaw);
  m_begin = rotation * -here;
  if (m_area) m_area->radius += SearchArea::drift * submap.driven();
  for (const SubmapPole& pole : submap.poles()) {
    m_queryPoles.push_back({rotation * (pole.centre - here),
                            rotation * submap.presentCovariance(pole, false) * rotation.transpose(),
                            rotation * (pole.seenFrom - here), oddsOf(pole, options), &pole});
  }
  // The pole seen later wins a tie: it has drifted less.
  std::stable_sort(m_queryPoles.begin(), m_queryPoles.end(),
                   [](const QueryPole& a, const QueryPole& b) {
                     return a.odds != b.odds ? a.odds > b.odds : a.pole->seenAt > b.pole->seenAt;
                   });
  if (m_queryPoles.size() > s_mostQueryPoles) m_queryPoles.resize(s_mostQueryPoles);
  while (m_reliable < m_queryPoles.size() && m_queryPoles[m_reliable].odds > 0) ++m_reliable;
  for (; m_reliable > s_mostReliable; --m_reliable) m_queryPoles[m_reliable - 1].odds = 0;
  for (const Eigen::Vector2d& place : submap.path()) {
    const Eigen::Vector2d seen = rotation * (place - here);
    if (m_path.empty() || (seen - m_path.back()).norm() >= s_pathStep) m_path.push_back(seen);
  }
}

bool Constellation::beganInArea(const Pose2D& pose_map_robot) const {
  if (!m_area) return true;
  const Eigen::Vector2d begin = Eigen::Vector2d(pose_map_robot.x, pose_map_robot.y) +
                                rotationOf(pose_map_robot.yaw) * m_begin;
  return (begin - m_area->centre_map).squaredNorm() <= m_area->radius * m_area->radius;
}

double Constellation::driftVariance(const QueryPole& a, const QueryPole& b) const {
  const bool aFirst = a.pole->seenAt <= b.pole->seenAt;
  const SubmapPole &then = aFirst ? *a.pole : *b.pole, &now = aFirst ? *b.pole : *a.pole;
  return 0.5 * OdometryDrift::between(then.drift, now.drift, then.centre).trace() +
         0.5 * m_scale * m_scale * (a.travel - b.travel).squaredNorm();
}

}  // namespace polemcl
