#include "config/MapUpdateBindings.h"

namespace polemcl {
namespace {

const Range abovezero = Range::above(0), zeroOrMore = Range::atLeast(0),
            chance = Range::inside(0, 1);

}  // namespace

void bind(Binder& b, MapUpdateOptions& o) {
  b.section("map_update", "How a map is kept true, session by session; gates are those of [map]");
  b.number("range_m", o.range, abovezero, "m", "nearer poles in free view are expected");
  b.number("detection", o.existence.detection, chance, "",
           "that such a pole is found in a scan, unless its own counts say less");
  b.number("false_detection", o.existence.falseDetection, chance, "",
           "that something is found in a scan where no pole is; below half of detection");
  b.number("look_m", o.existence.look, abovezero, "m", "scans of so many metres count as one");
  b.number("prior", o.existence.prior, chance, "", "that what is new is a pole, at first sight");
  b.number("certain", o.existence.certain, Range::inside(0.5, 1), "",
           "existence is never surer than this");
  b.number("lifetime_days", o.existence.lifetimeDays, abovezero, "days",
           "mean time a pole stands: existence decays between sessions");
  b.number("present", o.present, chance, "", "existence from which a pole enters the map");
  b.number("absent", o.absent, chance, "", "below which it leaves the map, and is remembered");
  b.number("forget", o.forget, {0, 1, false, true}, "", "below which it is forgotten");
  b.integer("min_seen", o.minSeen, Range::atLeast(1), "", "scans that found a pole on the map");
  b.number("session_sigma_m", o.sessionSigma, zeroOrMore, "m",
           "sigma of one session's places against those of others");
  b.number("moved_m", o.moved, abovezero, "m",
           "a pole surely farther from its place has been moved");
  b.number("ghost_m", o.ghost, zeroOrMore, "m",
           "a pole not found any more, nearer than this to a new one, is that one");
  b.check(o);
}

}  // namespace polemcl
