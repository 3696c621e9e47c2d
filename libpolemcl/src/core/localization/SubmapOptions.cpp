#include <polemcl/core/common/Binder.h>
#include <polemcl/core/localization/LocalSubmap.h>

namespace polemcl {

void bind(Binder& b, SubmapOptions& o) {
  const Range share = Range::between(0, 1);
  b.section("submap", "Poles of the last metres, kept in an odometry frame", Tier::expert);
  b.number("length_m", o.length, Range::aboveUpTo(0, 1000), "m",
           "poles not seen over this distance travelled are dropped");
  b.number("gate", o.gate, Range::aboveUpTo(0, 10), "",
           "greatest Mahalanobis distance of a detection from its pole");
  b.number("floor_m", o.floor, Range::aboveUpTo(0, 1), "m",
           "standard deviation of the error that all detections of a pole share");
  b.number("view_range_m", o.viewRange, Range::above(0), "m",
           "a nearer pole that is not detected is a missed chance");
  b.number("min_share", o.minShare, share, "share",
           "a pole seen in a smaller share of ten or more chances is dropped");
  b.integer("sure_hits", o.sureHits, Range::atLeast(1), "",
            "a pole with this number of hits is dropped by distance only");
  b.tier(Tier::tuning);
  b.number("position_walk", o.positionWalk, share, "m/sqrt(m)",
           "odometry without a covariance: standard deviation of the position after a metre");
  b.angleDeg("heading_walk_deg", o.headingWalk, Range::between(0, 57),
             "odometry without a covariance: standard deviation of the heading after a metre");
  b.number("turn_walk", o.turnWalk, share, "rad/sqrt(rad)",
           "odometry without a covariance: standard deviation of the heading after a radian");
  b.number("scale", o.scale, share, "", "standard deviation of the odometry's scale");
}

}  // namespace polemcl
