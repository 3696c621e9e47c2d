#include "core/common/TickStep.h"

#include <cmath>

#include <polemcl/core/common/Types.h>

namespace polemcl {

double tickStep(double span, int most) {
  if (!(span > 0) || !std::isfinite(span) || most < 1)
    throw Error("plot: ticks need a range of positive, finite length and at least one step");
  const double rough = span / most;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (double factor : {1.0, 2.0, 5.0})
    if (factor * power >= rough * (1 - 1e-9)) return factor * power;
  return 10 * power;
}

}  // namespace polemcl
