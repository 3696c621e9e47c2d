#include <cmath>
#include <sstream>

#include "core/global_localization/GlobalLocalizer.h"

namespace polemcl {
namespace {

void requireGlobal(bool good, const char* key, double value, const char* allowed) {
  if (good) return;
  std::ostringstream text;
  text << "[global] " << key << " = " << value << ": allowed is " << allowed;
  throw Error(text.str());
}

}  // namespace

void GlobalOptions::validate() const {
  requireGlobal(minHits >= 1, "min_hits", minHits, "1 or more");
  requireGlobal(mapped > 0 && mapped < 1, "mapped", mapped, "a share between 0 and 1");
  requireGlobal(sigma >= 0 && sigma <= 1, "sigma_m", sigma, "0 to 1");
  requireGlobal(maxTolerance > 0 && maxTolerance <= 5, "max_tolerance_m", maxTolerance,
                "more than 0, at most 5");
  requireGlobal(minBaseline >= 1, "min_baseline_m", minBaseline, "1 or more");
  requireGlobal(maxBaseline > minBaseline && maxBaseline <= 200, "max_baseline_m", maxBaseline,
                "more than min_baseline_m, at most 200");
  requireGlobal(corridor >= 0 && corridor <= 200, "corridor_m", corridor, "0 to 200");
  requireGlobal(seen >= 0 && seen < 1, "seen", seen, "a share from 0 to below 1");
  requireGlobal(minMatched >= 3, "min_matched", minMatched, "3 or more");
  requireGlobal(minShare >= 0 && minShare <= 1, "min_share", minShare, "0 to 1");
  requireGlobal(margin > 0 && std::isfinite(margin), "margin", margin, "more than 0");
  requireGlobal(distinct > 0 && std::isfinite(distinct), "distinct_m", distinct, "more than 0");
  requireGlobal(distinctYaw > 0 && distinctYaw <= M_PI, "distinct_yaw_deg",
                distinctYaw * 180 / M_PI, "more than 0, at most 180");
  requireGlobal(maxPairs >= 1, "max_pairs", maxPairs, "1 or more");
  requireGlobal(maxCandidates >= 1, "max_candidates", maxCandidates, "1 or more");
  requireGlobal(maxRefined >= 1, "max_refined", maxRefined, "1 or more");
  requireGlobal(maxHypotheses >= 2, "max_hypotheses", maxHypotheses, "2 or more");
}

}  // namespace polemcl
