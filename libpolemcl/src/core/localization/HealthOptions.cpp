#include <polemcl/core/common/Binder.h>
#include <polemcl/core/localization/LocalizationHealth.h>

namespace polemcl {
namespace {

void bindConfirmation(Binder& b, HealthOptions& o) {
  const Range positive = Range::above(0), share = Range::between(0, 1);
  b.number("confirm_m", o.confirm, Range::atLeast(0), "m",
           "distance with good matches until a new pose is ok");
  b.number("confirm_found_m", o.confirmFound, Range::atLeast(0), "m",
           "the same for a pose that the global search found");
  b.number("confirm_share", o.confirmShare, share, "share",
           "share of matched poles that confirms a new pose");
  b.number("confirm_within_m", o.confirmWithin, positive, "m",
           "lost: a new pose is not confirmed within this distance");

  b.require(o.confirmShare >= o.degradedShare, "confirm_share", o.confirmShare,
            "degraded_share or more");
  b.require(o.confirmWithin >= o.confirm, "confirm_within_m", o.confirmWithin, "confirm_m or more");
  b.require(o.confirmFound <= o.confirm, "confirm_found_m", o.confirmFound, "confirm_m or less");
}

}  // namespace

void bind(Binder& b, HealthOptions& o) {
  const Range positive = Range::above(0), share = Range::between(0, 1);
  b.section("health", "When the pose is called ok, degraded or lost", Tier::expert);
  b.number("window_m", o.window, positive, "m", "scans over this distance are judged together");
  b.number("lost_window_m", o.lostWindow, positive, "m",
           "lost: scans over this longer distance agree");
  b.number("min_sightings", o.minSightings, positive, "",
           "least sum of the confidences of poles in the window that says anything");
  b.number("lost_seen", o.lostSeen, share, "share",
           "lost: least number of poles a scan in the longer window, as a share of the usual");
  b.number("usual_m", o.usualWithin, positive, "m",
           "the usual number is a mean that forgets over this distance");
  b.number("lost_share", o.lostShare, share, "share",
           "lost: a smaller share of the observed poles is on the map");
  b.number("degraded_share", o.degradedShare, share, "share",
           "degraded: a smaller share of the observed poles is on the map");
  b.tier(Tier::tuning);
  b.number("lost_spread_m", o.lostSpread, positive, "m",
           "lost: greater standard deviation of the position");
  b.number("degraded_spread_m", o.degradedSpread, positive, "m",
           "degraded: greater standard deviation of the position");
  b.angleDeg("degraded_heading_deg", o.degradedHeading, Range::aboveUpTo(0, 180),
             "degraded: greater standard deviation of the heading");
  b.number("blind_s", o.blindSeconds, positive, "s", "degraded: no pole for a longer time");
  b.number("blind_m", o.blindMetres, positive, "m", "degraded: no pole over a longer distance");
  b.number("max_gap_s", o.maxGap, positive, "s", "degraded: a longer time between two scans");
  b.tier(Tier::expert);
  b.number("innovation", o.innovation, positive, "",
           "degraded: greater mean squared Mahalanobis distance per degree of freedom");
  b.number("mode_share", o.modeShare, share, "share",
           "degraded: a smaller share of the particles' weight in the likeliest place");
  bindConfirmation(b, o);

  b.require(o.lostWindow >= o.window, "lost_window_m", o.lostWindow, "window_m or more");
  b.require(o.degradedShare >= o.lostShare, "degraded_share", o.degradedShare,
            "lost_share or more");
  b.require(o.degradedSpread <= o.lostSpread, "degraded_spread_m", o.degradedSpread,
            "lost_spread_m or less");
}

}  // namespace polemcl
