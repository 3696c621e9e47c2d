#include "core/common/Binder.h"
#include "mrpt/filter/LocalizationPipeline.h"

namespace polemcl {

void bind(Binder& b, TrackingOptions& o) {
  b.section("tracking", "Which detections the filter is given");
  b.integer("min_hits", o.minHits, Range::atLeast(1), "", "poles seen in fewer scans are not used");
  b.number("every_m", o.every, Range::atLeast(0), "m",
           "distance travelled until a pole is used again");
  b.tier(Tier::expert);
  b.flag("average", o.average,
         "true: detections of a pole are averaged and used together; false: each for itself");
  b.choice<Cadence>(
      "cadence", o.cadence, {{Cadence::scan, "scan"}, {Cadence::section, "section"}},
      "detections are used at every scan, or at the end of each section those of its middle scan "
      "(authors' program)");
  bind(b, o.localMaps);
  b.require(!o.average || o.cadence == Cadence::scan, "cadence", "section",
            "scan where average = true");
}

void bind(Binder& b, LocalizationOptions& o) {
  bind(b, o.filter);
  bind(b, o.tracking);
  b.section("search", "When the whole map is searched for the vehicle");
  b.flag("recover", o.recover, "true: the map is searched when the vehicle is lost");
  b.section("health", "How far a pose can be trusted");
  b.number("max_gap_s", o.maxGap, Range::above(0), "s",
           "a longer time between two scans degrades the pose");
  b.section("odometry_monitor",
            "Detects faults of the odometry by the poles; their motion then replaces it");
  b.flag("enabled", o.monitorOdometry, "false: the odometry is always believed");
  b.section("odometry_calibration",
            "Scale error and yaw bias of the odometry are estimated while driving");
  b.flag("enabled", o.calibrateOdometry, "false: the odometry is taken as it is");
}

}  // namespace polemcl
