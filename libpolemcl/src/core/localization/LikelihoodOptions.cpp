#include <cmath>

#include <polemcl/core/localization/PoleLikelihood.h>
#include "core/common/Binder.h"

namespace polemcl {

void bind(Binder& b, LikelihoodOptions& o) {
  b.section("likelihood", "How well detections fit a map at a pose");
  b.tier(Tier::sensor);
  b.number("sigma_m", o.sigma, Range::between(1e-6, 1e3), "m",
           "standard deviation of a detection from its map pole; with weighted: beyond both "
           "covariances");
  b.tier(Tier::tuning);
  b.number("outlier", o.outlier, {1e-9, 1, false, true}, "",
           "model = mixture: share of detections that are not on the map");
  b.number("far_outlier", o.farOutlier, {1e-3, 1, false, false}, "",
           "model = mixture: weight of such a detection without a match, where one at a map pole "
           "weighs 1; 1: all alike");
  b.number("gate_m", o.gate, Range::aboveUpTo(0, 1e6), "m", "farther poles are no match");
  b.tier(Tier::expert);
  b.choice<LikelihoodModel>("model", o.model,
                            {{LikelihoodModel::paper, "paper"},
                             {LikelihoodModel::mixture, "mixture"},
                             {LikelihoodModel::floored, "floored"}},
                            "Eq. 3 of the paper, a mixture with outliers, or a density with a "
                            "floor (authors' program)");
  b.flag("weighted", o.weighted,
         "true: each detection counts by its covariance and confidence; false: all alike (paper)");
  b.number("floor", o.floor, Range::above(0), "1/m",
           "model = floored: added to the normal density");

  // Products of many factors must not underflow.
  b.require(o.outlier * o.farOutlier >= 1e-10, "far_outlier", o.farOutlier,
            "at least 1e-10 / outlier");
  if (o.model != LikelihoodModel::floored) return;
  const double peak = 1 / (o.sigma * std::sqrt(2 * M_PI));
  b.require(o.floor >= 1e-9 * (peak + o.floor), "floor", o.floor,
            "at least 1e-9 of the density's peak");
  b.require(!o.weighted, "weighted", "true",
            "false where model = floored, which takes all detections alike");
}

}  // namespace polemcl
