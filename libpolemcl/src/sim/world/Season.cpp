#include "sim/world/Season.h"

#include <algorithm>
#include <cmath>

namespace polemcl::sim {
namespace {
constexpr double kYear = 365;  // days

/// 0 until `from`, 1 after `to`, linear in between.
double rise(double day, double from, double to) {
  return std::clamp((day - from) / (to - from), 0.0, 1.0);
}
}  // namespace

Season seasonOf(double dayOfYear) {
  const double day = dayOfYear - 1 - kYear * std::floor((dayOfYear - 1) / kYear) + 1;
  Season season;
  season.foliage = std::min(rise(day, 105, 135), 1 - rise(day, 273, 325));
  season.snow = std::max(rise(day, 335, 355), 1 - rise(day, 45, 74));
  return season;
}

}  // namespace polemcl::sim
