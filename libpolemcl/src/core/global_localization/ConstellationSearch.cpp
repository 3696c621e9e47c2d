#include "core/global_localization/ConstellationSearch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_set>

#include "core/common/Transform.h"

namespace polemcl {
namespace {

constexpr double kPathStep = 4;            ///< m
constexpr std::size_t kMostReliable = 80;  ///< the best seen; more would only cost time
constexpr std::size_t kMostQueryPoles = 300;

/// Odds that a pole with this number of hits stands on the map. One hit more halves the doubt
/// whether it is a pole at all, less the more chances it missed.
double oddsOf(const SubmapPole& pole, const GlobalOptions& options) {
  if (pole.hits < static_cast<std::uint32_t>(options.minHits)) return 0;
  const double real = 1 - std::pow(0.5, std::min<double>(pole.hits, 30));
  const double p = options.mapped * real;
  return p / (1 - p);
}

/// Standard deviations of a tolerance: 96 % of true matches lie within, in the plane.
constexpr double kToleranceSigmas = 2.5;
constexpr int kMostUses = 4;  ///< of one query pole in pairs: a false one must not spoil them all

/// Least hits after `probes` probes. A true place, where six of ten query poles find their pole,
/// falls short once in a hundred times, and up to `maxPairs` pairs can find it; of chance ones,
/// with three hits in a hundred probes, hardly any gets through.
constexpr std::uint32_t leastHits(std::uint32_t probes) {
  return probes < 6 ? 0 : probes < 10 ? 1 : probes < 16 ? 2 : probes < 24 ? 5 : 8;
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
  if (m_queryPoles.size() > kMostQueryPoles) m_queryPoles.resize(kMostQueryPoles);
  while (m_reliable < m_queryPoles.size() && m_queryPoles[m_reliable].odds > 0) ++m_reliable;
  for (; m_reliable > kMostReliable; --m_reliable) m_queryPoles[m_reliable - 1].odds = 0;
  for (const Eigen::Vector2d& place : submap.path()) {
    const Eigen::Vector2d seen = rotation * (place - here);
    if (m_path.empty() || (seen - m_path.back()).norm() >= kPathStep) m_path.push_back(seen);
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

PairTolerance::PairTolerance(const PreparedMap& map, const Constellation& query,
                             const QueryPole& first, const QueryPole& second)
    : m_map(map),
      m_query(query),
      m_first(first),
      m_second(second),
      m_middle(0.5 * (first.centre + second.centre)),
      m_squaredLength((second.centre - first.centre).squaredNorm()) {
  const double sigma = map.options.sigma;
  m_variance = query.relativeVariance(first, second) + 2 * (sigma * sigma + map.meanVariance);
}

double PairTolerance::of(const QueryPole& queryPole) const {
  // Variance of the pair's middle: a quarter of the sum of both variances. Variance of its
  // direction: that sum divided by the squared length.
  const double lever = (queryPole.centre - m_middle).squaredNorm() / m_squaredLength;
  const double sigma = m_map.options.sigma;
  const double own = 0.5 * queryPole.pole->covariance.trace() + sigma * sigma + m_map.meanVariance;
  const double drift = std::min(m_query.driftVariance(queryPole, m_first),
                                m_query.driftVariance(queryPole, m_second));
  const double variance = m_variance * (0.25 + lever) + own + drift;
  return std::min(m_map.options.maxTolerance, kToleranceSigmas * std::sqrt(variance));
}

ConstellationSearch::ConstellationSearch(const PreparedMap& map, const Constellation& query)
    : m_map(map), m_query(query) {}

std::vector<PoseCandidate> ConstellationSearch::run() {
  for (const QueryPair& pair : choosePairs()) tryPair(pair);
  return bestSeeds();
}

/// Rare distances come first: they cost least and decide most.
std::vector<ConstellationSearch::QueryPair> ConstellationSearch::choosePairs() const {
  const GlobalOptions& options = m_map.options;
  const std::vector<QueryPole>& queryPoles = m_query.queryPoles();
  std::vector<QueryPair> all;
  for (std::uint32_t i = 0; i < m_query.reliable(); ++i) {
    for (std::uint32_t j = i + 1; j < m_query.reliable(); ++j) {
      const double length = (queryPoles[i].centre - queryPoles[j].centre).norm();
      if (length < options.minBaseline || length > options.maxBaseline) continue;
      const double variance = m_query.relativeVariance(queryPoles[i], queryPoles[j]) +
                              2 * (options.sigma * options.sigma + m_map.meanVariance);
      const double tolerance =
          std::min(options.maxTolerance, kToleranceSigmas * std::sqrt(variance));
      const PairDistanceIndex::Range range =
          m_map.pairs.between(length - tolerance, length + tolerance);
      // A short or a doubtful pair is worth less: many places fit it badly.
      const double doubt = (1 + 1 / queryPoles[i].odds) * (1 + 1 / queryPoles[j].odds);
      const double cost =
          (1.0 + static_cast<double>(range.size())) * (1 + 100 / (length * length)) * doubt * doubt;
      all.push_back({cost, i, j, range});
    }
  }
  std::sort(all.begin(), all.end(), [](const QueryPair& a, const QueryPair& b) {
    if (a.cost != b.cost) return a.cost < b.cost;
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  });
  std::vector<QueryPair> chosen;
  std::vector<int> uses(m_query.reliable(), 0);
  std::size_t candidates = 0;
  for (const QueryPair& pair : all) {
    if (uses[pair.first] >= kMostUses || uses[pair.second] >= kMostUses) continue;
    candidates += 2 * pair.range.size();
    if (chosen.size() >= static_cast<std::size_t>(options.maxPairs) ||
        (!chosen.empty() && candidates > static_cast<std::size_t>(options.maxCandidates)))
      break;
    ++uses[pair.first];
    ++uses[pair.second];
    chosen.push_back(pair);
  }
  return chosen;
}

void ConstellationSearch::tryPair(const QueryPair& pair) {
  const std::vector<QueryPole>& queryPoles = m_query.queryPoles();
  const PairTolerance tolerance(m_map, m_query, queryPoles[pair.first], queryPoles[pair.second]);
  m_probes.clear();
  for (std::uint32_t i = 0; i < m_query.reliable(); ++i) {
    if (i == pair.first || i == pair.second) continue;
    const double t = tolerance.of(queryPoles[i]);
    m_probes.push_back({queryPoles[i].centre.x(), queryPoles[i].centre.y(), t * t});
  }
  std::stable_sort(m_probes.begin(), m_probes.end(), [](const Probe& a, const Probe& b) {
    return a.squaredTolerance < b.squaredTolerance;
  });
  for (const PairDistanceIndex::Pair* p = pair.range.begin; p != pair.range.end; ++p) {
    const Eigen::Vector2d &a = m_map.index.tree().point(p->first),
                          &b = m_map.index.tree().point(p->second);
    tryPlace(pair, a, b);
    tryPlace(pair, b, a);
  }
}

void ConstellationSearch::tryPlace(const QueryPair& pair, const Eigen::Vector2d& first,
                                   const Eigen::Vector2d& second) {
  ++m_candidates;
  const Eigen::Vector2d &a = m_query.queryPoles()[pair.first].centre,
                        &b = m_query.queryPoles()[pair.second].centre;
  const Eigen::Vector2d seen = b - a, mapped = second - first;
  const double norm = std::sqrt(seen.squaredNorm() * mapped.squaredNorm());
  const double c = seen.dot(mapped) / norm;
  const double s = (seen.x() * mapped.y() - seen.y() * mapped.x()) / norm;
  const Eigen::Vector2d middle = 0.5 * (a + b);
  const double x = 0.5 * (first.x() + second.x()) - (c * middle.x() - s * middle.y());
  const double y = 0.5 * (first.y() + second.y()) - (s * middle.x() + c * middle.y());
  std::uint32_t hits = 0, tried = 0;
  for (const Probe& probe : m_probes) {
    hits += static_cast<bool>(m_map.index.grid().nearest(
        x + c * probe.x - s * probe.y, y + s * probe.x + c * probe.y, probe.squaredTolerance));
    if (hits < leastHits(++tried)) return;
  }
  const Pose2D place{x, y, std::atan2(s, c)};
  if (hits < 2 || !m_query.beganInArea(place)) return;
  m_seeds.push_back({place, hits, pair.first, pair.second});
}

std::vector<PoseCandidate> ConstellationSearch::bestSeeds() {
  std::stable_sort(m_seeds.begin(), m_seeds.end(),
                   [](const PoseCandidate& a, const PoseCandidate& b) { return a.hits > b.hits; });
  const auto cellOf = [](const Pose2D& pose) {
    const auto column = static_cast<std::int64_t>(std::floor(pose.x / 2));
    const auto row = static_cast<std::int64_t>(std::floor(pose.y / 2));
    const auto turn = static_cast<std::uint64_t>((pose.yaw + M_PI) / (2 * M_PI) * 60);
    return (static_cast<std::uint64_t>(column) * 0x9E3779B97F4A7C15u ^
            static_cast<std::uint64_t>(row)) *
               64 +
           turn % 60;
  };
  std::unordered_set<std::uint64_t> taken;
  std::vector<PoseCandidate> best;
  for (const PoseCandidate& seed : m_seeds) {
    if (best.size() >= static_cast<std::size_t>(m_map.options.maxRefined)) break;
    if (taken.insert(cellOf(seed.pose_map_robot)).second) best.push_back(seed);
  }
  return best;
}

}  // namespace polemcl
