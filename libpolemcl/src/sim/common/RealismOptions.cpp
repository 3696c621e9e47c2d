#include "sim/common/RealismOptions.h"

#include "core/common/Binder.h"

namespace polemcl::sim {

void bind(Binder& b, RealismOptions& o) {
  b.section("realism", "Deviations of simulated streets and LiDARs from clean models");
  b.number("scale", o.scale, Range::between(0, 5), "", "multiplies all rates below; 0: none");
  b.number("rain_mm_h", o.rain, Range::between(0, 100), "mm/h", "rain");
}

}  // namespace polemcl::sim
