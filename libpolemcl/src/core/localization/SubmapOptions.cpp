#include <cmath>
#include <sstream>

#include "core/localization/LocalSubmap.h"

namespace polemcl {
namespace {

void requireSubmap(bool good, const char* key, double value, const char* allowed) {
  if (good) return;
  std::ostringstream text;
  text << "[submap] " << key << " = " << value << ": allowed is " << allowed;
  throw Error(text.str());
}

bool isFraction(double value) {
  return value >= 0 && value <= 1;
}

}  // namespace

void SubmapOptions::validate() const {
  requireSubmap(length > 0 && length <= 1000, "length_m", length, "more than 0, at most 1000");
  requireSubmap(gate > 0 && gate <= 10, "gate", gate, "more than 0, at most 10");
  requireSubmap(floor > 0 && floor <= 1, "floor_m", floor, "more than 0, at most 1");
  requireSubmap(viewRange > 0 && std::isfinite(viewRange), "view_range_m", viewRange,
                "more than 0");
  requireSubmap(isFraction(minShare), "min_share", minShare, "0 to 1");
  requireSubmap(sureHits >= 1, "sure_hits", sureHits, "1 or more");
  requireSubmap(isFraction(positionWalk), "position_walk", positionWalk, "0 to 1");
  requireSubmap(isFraction(headingWalk), "heading_walk_deg", headingWalk * 180 / M_PI, "0 to 57");
  requireSubmap(isFraction(turnWalk), "turn_walk", turnWalk, "0 to 1");
  requireSubmap(isFraction(scale), "scale", scale, "0 to 1");
}

}  // namespace polemcl
