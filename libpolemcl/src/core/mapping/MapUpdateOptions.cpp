#include <polemcl/core/common/Binder.h>
#include <polemcl/core/mapping/MapUpdater.h>
#include <polemcl/core/mapping/PoleExistence.h>

namespace polemcl {
namespace {

const Range s_chance = Range::inside(0, 1);
constexpr const char* s_updateSection = "map_update";
constexpr const char* s_updateComment =
    "How sessions update a map; gates and pose errors are those of [map]";

}  // namespace

void bind(Binder& b, ExistenceOptions& o) {
  b.section(s_updateSection, s_updateComment);
  b.number("lifetime_days", o.lifetimeDays, Range::above(0), "days",
           "mean time that a pole stands; its existence decays between sessions");
  b.tier(Tier::expert);
  b.number("detection", o.detection, s_chance, "",
           "probability that a scan finds a pole in view; the pole's own counts may lower it");
  b.number("false_detection", o.falseDetection, s_chance, "",
           "probability that a scan finds something where no pole is");
  b.number("decorrelation_m", o.decorrelation, Range::above(0), "m",
           "scans within this distance along the path count as one");
  b.number("prior", o.prior, s_chance, "",
           "prior probability that a newly observed object is a pole");
  b.number("certain", o.certain, Range::inside(0.5, 1), "",
           "greatest probability of existence; 1 - certain is the least");
  b.require(2 * o.falseDetection < o.detection, "false_detection", o.falseDetection,
            "below half of detection");
}

void bind(Binder& b, AlignmentOptions& o) {
  b.section(s_updateSection, s_updateComment);
  b.number("align_sigma_m", o.sigma, Range::atLeast(0), "m",
           "standard deviation of a session's positions before it is aligned to the map; 0: it is "
           "not aligned");
  b.tier(Tier::expert);
  b.angleDeg("align_sigma_deg", o.headingSigma, Range::aboveUpTo(0, 57),
             "standard deviation of its headings");
  b.number("align_length_m", o.length, Range::above(0), "m",
           "distance over which these errors are correlated");
  b.integer("align_min_poles", o.minPoles, Range::atLeast(2), "",
            "least number of map poles seen within 50 m of path; pieces with fewer follow others");
}

void bind(Binder& b, MapUpdateOptions& o) {
  b.section(s_updateSection, s_updateComment);
  b.number("range_m", o.range, Range::above(0), "m",
           "a scan is expected to find poles in view up to this distance");
  b.integer("min_seen", o.minSeen, Range::atLeast(1), "",
            "least number of scans that found a pole on the map");
  b.number("present", o.present, s_chance, "", "existence from which a pole enters the map");
  b.number("absent", o.absent, s_chance, "",
           "existence below which a pole leaves the map; it is remembered");
  b.number("moved_m", o.moved, Range::above(0), "m",
           "a pole that is surely farther than this from its place has been moved");
  b.tier(Tier::expert);
  b.number("forget", o.forget, Range::fromBelow(0, 1), "",
           "existence below which a pole is forgotten");
  b.number("session_sigma_m", o.sessionSigma, Range::atLeast(0), "m",
           "standard deviation of one session's positions against those of others");
  b.number("ghost_m", o.ghost, Range::atLeast(0), "m",
           "a missed pole that is nearer than this to a new one has been moved there");
  b.number("max_sigma_m", o.maxSigma, Range::above(0), "m",
           "scans with a greater standard deviation of their estimated position change nothing");
  bind(b, o.existence);
  bind(b, o.alignment);
  b.require(o.present <= o.existence.certain, "present", o.present, "certain or less");
  b.require(o.absent <= o.present, "absent", o.absent, "present or less");
  b.require(o.forget < o.absent, "forget", o.forget, "less than absent");
}

}  // namespace polemcl
