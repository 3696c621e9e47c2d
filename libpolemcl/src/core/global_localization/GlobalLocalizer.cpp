#include <algorithm>
#include <cmath>

#include "core/global_localization/PoseRefinement.h"
#include "core/global_localization/PreparedMap.h"

namespace polemcl {
namespace {

bool samePlace(const Pose2D& a, const Pose2D& b, const GlobalOptions& options) {
  return std::hypot(a.x - b.x, a.y - b.y) <= options.distinct &&
         std::abs(wrapAngle(a.yaw - b.yaw)) <= options.distinctYaw;
}

/// By falling logRatio, of each place only the best.
void rank(std::vector<GlobalHypothesis>& all, const GlobalOptions& options) {
  std::stable_sort(
      all.begin(), all.end(),
      [](const GlobalHypothesis& a, const GlobalHypothesis& b) { return a.logRatio > b.logRatio; });
  std::vector<GlobalHypothesis> kept;
  for (const GlobalHypothesis& next : all) {
    if (kept.size() >= static_cast<std::size_t>(options.maxHypotheses)) break;
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const GlobalHypothesis& other) {
      return samePlace(next.pose_map_robot, other.pose_map_robot, options);
    });
    if (!known) kept.push_back(next);
  }
  double sum = 0;
  for (const GlobalHypothesis& h : kept) sum += std::exp(h.logRatio - kept[0].logRatio);
  for (GlobalHypothesis& h : kept) h.weight = std::exp(h.logRatio - kept[0].logRatio) / sum;
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
  const double second = result.hypotheses.size() > 1 ? result.hypotheses[1].logRatio : 0;
  if (best.logRatio - std::max(0.0, second) < options.margin)
    return say(GlobalVerdict::ambiguous, GlobalReason::rivals);
  say(GlobalVerdict::resolved, GlobalReason::clear);
}

}  // namespace

GlobalLocalizer::GlobalLocalizer(const std::vector<MapPole>& map, const GlobalOptions& options)
    : m_map(std::make_shared<const PreparedMap>(map, options)) {}

GlobalResult GlobalLocalizer::localize(const LocalSubmap& submap,
                                       const std::optional<SearchArea>& area) const {
  const GlobalOptions& options = m_map->options;
  GlobalResult result;
  const Constellation query(submap, options, area);
  result.poles = query.reliable();
  if (result.poles < static_cast<std::size_t>(options.minMatched)) return result;
  ConstellationSearch search(*m_map, query);
  const std::vector<PoseCandidate> seeds = search.run();
  result.candidates = search.candidates();
  PoseRefinement refinement(*m_map, query, submap.pose());
  for (const PoseCandidate& seed : seeds) {
    GlobalHypothesis hypothesis;
    if (refinement.run(seed, hypothesis)) result.hypotheses.push_back(hypothesis);
  }
  rank(result.hypotheses, options);
  decide(result, options);
  return result;
}

}  // namespace polemcl
