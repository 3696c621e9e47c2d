#include <algorithm>
#include <cmath>
#include <string>

#include "core/global_localization/PoseRefinement.h"

namespace polemcl {
namespace {

std::vector<Eigen::Vector2d> mapCentres(const std::vector<MapPole>& map) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(map.size());
  for (const MapPole& pole : map) {
    if (!std::isfinite(pole.x) || !std::isfinite(pole.y) || !pole.covariance.allFinite())
      throw Error("pole " + std::to_string(points.size()) +
                  " of the map has a centre or covariance that is not finite; remove it");
    points.emplace_back(pole.x, pole.y);
  }
  return points;
}

const GlobalOptions& checked(const GlobalOptions& options) {
  options.validate();
  return options;
}

bool samePlace(const Pose2D& a, const Pose2D& b, const GlobalOptions& options) {
  return std::hypot(a.x - b.x, a.y - b.y) <= options.distinct &&
         std::abs(wrapAngle(a.yaw - b.yaw)) <= options.distinctYaw;
}

/// By falling evidence, of each place only the best.
void rank(std::vector<GlobalHypothesis>& all, const GlobalOptions& options) {
  std::stable_sort(
      all.begin(), all.end(),
      [](const GlobalHypothesis& a, const GlobalHypothesis& b) { return a.evidence > b.evidence; });
  std::vector<GlobalHypothesis> kept;
  for (const GlobalHypothesis& next : all) {
    if (kept.size() >= static_cast<std::size_t>(options.maxHypotheses)) break;
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const GlobalHypothesis& other) {
      return samePlace(next.pose_map_robot, other.pose_map_robot, options);
    });
    if (!known) kept.push_back(next);
  }
  double sum = 0;
  for (const GlobalHypothesis& h : kept) sum += std::exp(h.evidence - kept[0].evidence);
  for (GlobalHypothesis& h : kept) h.weight = std::exp(h.evidence - kept[0].evidence) / sum;
  all = std::move(kept);
}

void decide(GlobalResult& result, const GlobalOptions& options) {
  const auto say = [&](GlobalVerdict verdict, GlobalReason reason) {
    result.verdict = verdict;
    result.reason = reason;
  };
  if (result.hypotheses.empty()) return say(GlobalVerdict::none, GlobalReason::noPlace);
  const GlobalHypothesis& best = result.hypotheses[0];
  if (best.matched < static_cast<std::uint32_t>(options.minMatched))
    return say(GlobalVerdict::none, GlobalReason::fewMatched);
  if (best.matchedShare < options.minShare)
    return say(GlobalVerdict::none, GlobalReason::smallShare);
  // Against nothing at all it must lead as well.
  const double second = result.hypotheses.size() > 1 ? result.hypotheses[1].evidence : 0;
  if (best.evidence - std::max(0.0, second) < options.margin)
    return say(GlobalVerdict::ambiguous, GlobalReason::rivals);
  say(GlobalVerdict::resolved, GlobalReason::clear);
}

}  // namespace

GlobalLocalizer::GlobalLocalizer(const std::vector<MapPole>& map, const GlobalOptions& options)
    : m_options(checked(options)),
      m_tree(mapCentres(map)),
      m_grid(mapCentres(map), options.maxTolerance),
      m_pairs(mapCentres(map), options.minBaseline, options.maxBaseline) {
  m_variances.reserve(map.size());
  for (const MapPole& pole : map) {
    m_variances.push_back(0.5 * pole.covariance.trace());
    m_meanVariance += m_variances.back() / static_cast<double>(map.size());
  }
}

GlobalResult GlobalLocalizer::localize(const LocalSubmap& submap) const {
  GlobalResult result;
  const Constellation sky(submap, m_options);
  result.poles = sky.reliable();
  if (result.poles < static_cast<std::size_t>(m_options.minMatched)) return result;
  ConstellationSearch search(*this, sky);
  const std::vector<PoseCandidate> seeds = search.run();
  result.candidates = search.candidates();
  PoseRefinement refinement(*this, sky, submap.pose());
  for (const PoseCandidate& seed : seeds) {
    GlobalHypothesis hypothesis;
    if (refinement.run(seed, hypothesis)) result.hypotheses.push_back(hypothesis);
  }
  rank(result.hypotheses, m_options);
  decide(result, m_options);
  return result;
}

}  // namespace polemcl
