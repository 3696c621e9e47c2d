#include "core/common/Binder.h"
#include "core/mapping/MapUpdater.h"

namespace polemcl {
void bind(Binder& b, MapUpdateOptions& o) {
  b.section("map_update", "How sessions update a map; gates and pose errors are those of [map]");
  b.number("range_m", o.range, Range::above(0), "m",
           "a scan is expected to find poles in view up to this distance");
  b.integer("min_seen", o.minSeen, Range::atLeast(1), "",
            "least number of scans that found a pole on the map");
  b.number("moved_m", o.moved, Range::above(0), "m",
           "a pole that is surely farther than this from its place has been moved");
  b.number("lifetime_days", o.lifetimeDays, Range::above(0), "days",
           "mean time that a pole stands; its existence decays between sessions");
  b.number("align_sigma_m", o.alignSigma, Range::between(0, 1000), "m",
           "standard deviation of a session's positions before it is aligned to the map; 0: it is "
           "not aligned");
  b.tier(Tier::expert);
  b.number("session_sigma_m", o.sessionSigma, Range::between(0, 1000), "m",
           "standard deviation of one session's positions against those of others");
}

}  // namespace polemcl
