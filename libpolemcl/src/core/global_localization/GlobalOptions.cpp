#include <polemcl/core/common/Binder.h>
#include <polemcl/core/global_localization/GlobalLocalizer.h>
#include "core/common/Angles.h"

namespace polemcl {

void bind(Binder& b, GlobalOptions& o) {
  b.section("global", "The place of a submap on the whole map", Tier::expert);
  b.integer("min_hits", o.minHits, Range::atLeast(1), "",
            "poles of the submap with fewer hits are not used");
  b.number("mapped", o.mapped, Range::inside(0, 1), "",
           "probability that a true pole of the submap is on the map");
  b.number("sigma_m", o.sigma, Range::between(0, 1), "m",
           "standard deviation of a pole from its map pole, beyond both covariances");
  b.number("radius_sigma_m", o.radiusSigma, Range::above(0), "m",
           "standard deviation of a pole's radius from that of its map pole");
  b.number("max_tolerance_m", o.maxTolerance, Range::aboveUpTo(0, 5), "m",
           "greatest distance of a pole from its map pole");
  b.number("min_baseline_m", o.minBaseline, Range::atLeast(1), "m",
           "least distance of the pole pairs that are looked up");
  b.number("max_baseline_m", o.maxBaseline, Range::aboveUpTo(1, 200), "m",
           "greatest distance of the pole pairs that are looked up");
  b.number("corridor_m", o.corridor, Range::between(0, 200), "m",
           "map poles nearer than this to the path should have been seen");
  b.number("seen", o.seen, Range::fromBelow(0, 1), "",
           "probability that such a pole is in the submap");
  b.tier(Tier::tuning);
  b.integer("min_matched", o.minMatched, Range::atLeast(3), "",
            "least number of matched poles of an answer");
  b.number("min_share", o.minShare, Range::between(0, 1), "share",
           "least share of the submap's poles that are matched");
  b.number("margin", o.margin, Range::above(0), "nats",
           "least lead in log-likelihood over every other place");
  b.tier(Tier::expert);
  b.number("distinct_m", o.distinct, Range::above(0), "m",
           "places farther apart than this are different ones");
  b.angleDeg("distinct_yaw_deg", o.distinctYaw, Range::aboveUpTo(0, 180),
             "places turned by more than this are different ones");
  b.integer("max_pairs", o.maxPairs, Range::atLeast(1), "",
            "greatest number of pole pairs that are looked up");
  b.integer("max_candidates", o.maxCandidates, Range::atLeast(1), "",
            "greatest number of places that are tried");
  b.integer("max_refined", o.maxRefined, Range::atLeast(1), "",
            "greatest number of places that are refined");
  b.integer("max_hypotheses", o.maxHypotheses, Range::atLeast(2), "",
            "greatest number of places in an answer");

  b.require(o.maxBaseline > o.minBaseline, "max_baseline_m", o.maxBaseline,
            "more than min_baseline_m");
}

}  // namespace polemcl
