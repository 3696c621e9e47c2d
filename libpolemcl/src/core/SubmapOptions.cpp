#include <polemcl/core/LocalSubmap.h>

#include <cmath>
#include <sstream>

namespace polemcl {
namespace {

void require(bool good, const char* key, double value, const char* allowed) {
  if (good) return;
  std::ostringstream text;
  text << "[submap] " << key << " = " << value << ": allowed is " << allowed;
  throw Error(text.str());
}

bool isShare(double value) {
  return value >= 0 && value <= 1;
}

}  // namespace

void SubmapOptions::validate() const {
  require(length > 0 && length <= 1000, "length_m", length, "more than 0, at most 1000");
  require(gate > 0 && gate <= 10, "gate", gate, "more than 0, at most 10");
  require(floor > 0 && floor <= 1, "floor_m", floor, "more than 0, at most 1");
  require(viewRange > 0 && std::isfinite(viewRange), "view_range_m", viewRange, "more than 0");
  require(isShare(minShare), "min_share", minShare, "0 to 1");
  require(sureHits >= 1, "sure_hits", sureHits, "1 or more");
  require(isShare(positionWalk), "position_walk", positionWalk, "0 to 1");
  require(isShare(headingWalk), "heading_walk_deg", headingWalk * 180 / M_PI, "0 to 57");
  require(isShare(turnWalk), "turn_walk", turnWalk, "0 to 1");
  require(isShare(scale), "scale", scale, "0 to 1");
}

}  // namespace polemcl
