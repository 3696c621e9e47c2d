#include <polemcl/core/common/Binder.h>
#include <polemcl/core/localization/OdometryMonitor.h>

namespace polemcl {

void bind(Binder& b, OdometryMonitorOptions& o) {
  const Range positive = Range::above(0), notNegative = Range::atLeast(0);
  b.section("odometry_monitor",
            "Detects faults of the odometry by the poles; their motion then replaces it");
  b.flag("enabled", o.enabled, "false: the odometry is always believed");
  b.number("scale", o.scale, Range::fromBelow(0, 1), "",
           "tolerated error of the odometry, as a share of the distance");
  b.number("max_speed_m_s", o.maxSpeed, positive, "m/s", "greatest speed of the vehicle");
  b.angleDeg("max_turn_rate_deg_s", o.maxTurnRate, positive,
             "greatest turn rate of the vehicle, in deg/s");
  b.tier(Tier::expert);
  b.number("window_s", o.window, positive, "s", "longest time over which scans are compared");
  b.number("tolerance_m", o.metres, notNegative, "m", "tolerated error of any motion");
  b.angleDeg("tolerance_deg", o.turn, Range::between(0, 180), "tolerated error of any turn");
  b.number("sigmas", o.sigmas, positive, "",
           "least difference beyond the tolerance that contradicts, in standard deviations");
  b.integer("min_pairs", o.minPairs, Range::atLeast(3), "",
            "least number of poles in common that contradict");
  b.number("min_share", o.minShare, Range::between(0, 1), "share",
           "least share of poles in common");
  b.number("margin", o.margin, notNegative, "poles",
           "least lead of the poles' motion over the odometry's");
  b.number("settle_s", o.settle, positive, "s",
           "time of agreement after which the odometry is believed again");
  b.number("hold_s", o.hold, notNegative, "s",
           "time for which the last speed is kept without poles");
  b.number("sigma_m", o.alignment.sigma, Range::aboveUpTo(0, 1), "m",
           "added to the standard deviation of each detection");
  b.number("gate", o.alignment.gate, positive, "", "greatest Mahalanobis distance of a pair");
  b.number("reach_m", o.alignment.reach, positive, "m",
           "greatest distance of a pair at the first guess");

  b.require(o.settle <= o.window, "settle_s", o.settle, "window_s or less");
}

}  // namespace polemcl
