#include "sim/common/RealismOptions.h"

#include <polemcl/core/common/Binder.h>

namespace polemcl::sim {

void bind(Binder& b, RealismOptions& o) {
  const Range share = Range::between(0, 1);
  b.section("realism", "Deviations of simulated streets and LiDARs from clean models");
  b.number("scale", o.scale, Range::between(0, 5), "", "multiplies all rates below; 0: none");
  b.number("crooked", o.crooked, share, "", "share of bent poles and trunks");
  b.number("tapered", o.tapered, share, "", "share of posts thicker below and thinner above");
  b.number("leaning", o.leaning, share, "", "share of poles that lean by 1.5 to 6 degrees");
  b.number("multiple", o.multiple, share, "",
           "share of posts with one or two more 0.3 to 0.6 m beside");
  b.number("boxes", o.boxes, share, "", "share of posts with a box on them");
  b.number("ivy", o.ivy, share, "", "share of poles and trunks with ivy around the lower part");
  b.number("hedges", o.hedges, share, "", "share of poles with a hedge against them");
  b.number("range_bias_m", o.rangeBias, Range::between(0, 0.2), "m",
           "standard deviation of each beam's own bias");
  b.number("range_walk_m", o.rangeWalk, Range::between(0, 0.2), "m",
           "dim returns are longer, bright ones shorter by this");
  b.number("dark_dropout", o.darkDropout, share, "", "share of the pulses lost on black surfaces");
  b.number("rain_mm_h", o.rain, Range::between(0, 100), "mm/h", "rain");
  b.number("spray", o.spray, share, "",
           "share of the pulses to the back that meet the car's own spray");
}

}  // namespace polemcl::sim
