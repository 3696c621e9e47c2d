#include <polemcl/core/common/Binder.h>
#include <polemcl/mrpt/filter/LocalizationPipeline.h>

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
      "(first implementation)");
  bind(b, o.localMaps);
  b.require(!o.average || o.cadence == Cadence::scan, "cadence", "section",
            "scan where average = true");
}

void bind(Binder& b, SearchOptions& o) {
  b.section("search", "When the whole map is searched for the vehicle");
  b.flag("recover", o.recover, "true: the map is searched when the vehicle is lost");
  b.number("patience_m", o.patience, Range::atLeast(0), "m",
           "distance travelled until an ambiguous answer is used");
  b.tier(Tier::expert);
  b.number("every_m", o.every, Range::above(0), "m", "distance travelled between two searches");
  b.number("every_s", o.everySeconds, Range::above(0), "s",
           "time between two searches of a vehicle that stands");
  b.integer("particles", o.particles, Range::between(1, 1000000), "",
            "number of particles drawn round the places of an answer");
}

void bind(Binder& b, LocalizationOptions& o) {
  bind(b, o.filter);
  bind(b, o.tracking);
  bind(b, o.submap);
  bind(b, o.health);
  bind(b, o.search);
  bind(b, o.odometryMonitor);
  bind(b, o.odometryCalibration);
}

}  // namespace polemcl
