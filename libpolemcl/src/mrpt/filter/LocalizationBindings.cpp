#include "config/Bindings.h"
#include "mrpt/filter/LocalizationPipeline.h"

namespace polemcl {
namespace {

const Range positive = Range::above(0), share = Range::between(0, 1);

}  // namespace

void bind(Binder& b, SubmapOptions& o) {
  b.section("submap", "Poles of the last metres, kept in an odometry frame");
  b.number("length_m", o.length, {0, 1000, true, false}, "m",
           "poles not seen over so many driven metres are dropped");
  b.number("gate", o.gate, {0, 10, true, false}, "",
           "greatest Mahalanobis distance of a detection from its pole");
  b.number("floor_m", o.floor, {0, 1, true, false}, "m",
           "error that all detections of a pole share");
  b.number("view_range_m", o.viewRange, positive, "m",
           "a nearer pole that is not detected is a missed chance");
  b.number("min_share", o.minShare, share, "share",
           "poles seen in fewer of ten chances are dropped");
  b.integer("sure_hits", o.sureHits, Range::atLeast(1), "", "with so many hits they stay");
  b.number("position_walk", o.positionWalk, share, "m/sqrt(m)",
           "odometry: standard deviation of the position after a metre");
  b.angleDeg("heading_walk_deg", o.headingWalk, Range::between(0, 57),
             "odometry: standard deviation of the heading after a metre");
  b.number("turn_walk", o.turnWalk, share, "rad/sqrt(rad)",
           "odometry: standard deviation of the heading after a radian turned");
  b.number("scale", o.scale, share, "", "odometry: standard deviation of its scale");
  b.check(o);
}

void bind(Binder& b, GlobalOptions& o) {
  b.section("global", "The place of a submap on the whole map");
  b.integer("min_hits", o.minHits, Range::atLeast(1), "", "poles seen less often do not count");
  b.number("mapped", o.mapped, Range::inside(0, 1), "", "chance that a pole is on the map");
  b.number("sigma_m", o.sigma, Range::between(0, 1), "m", "of a pole against its map pole");
  b.number("max_tolerance_m", o.maxTolerance, {0, 5, true, false}, "m",
           "greatest distance of a match");
  b.number("min_baseline_m", o.minBaseline, Range::atLeast(1), "m",
           "least distance of the pole pairs that are looked up");
  b.number("max_baseline_m", o.maxBaseline, {1, 200, true, false}, "m",
           "greatest distance of them");
  b.number("corridor_m", o.corridor, Range::between(0, 200), "m",
           "map poles this near to the way should have been seen");
  b.number("seen", o.seen, {0, 1, false, true}, "", "chance that such a pole was");
  b.integer("min_matched", o.minMatched, Range::atLeast(3), "", "fewer matched poles never decide");
  b.number("min_share", o.minShare, share, "share", "least share of the poles that must match");
  b.number("margin", o.margin, positive, "nats", "least lead in evidence over every other place");
  b.number("distinct_m", o.distinct, positive, "m", "places farther apart are different ones");
  b.angleDeg("distinct_yaw_deg", o.distinctYaw, {0, 180, true, false}, "or turned by more");
  b.integer("max_pairs", o.maxPairs, Range::atLeast(1), "", "most pole pairs that are looked up");
  b.integer("max_candidates", o.maxCandidates, Range::atLeast(1), "", "most places that are tried");
  b.integer("max_refined", o.maxRefined, Range::atLeast(1), "", "most that are refined");
  b.integer("max_hypotheses", o.maxHypotheses, Range::atLeast(2), "", "most that are handed out");
  b.check(o);
}

void bind(Binder& b, HealthOptions& o) {
  b.section("health", "When the pose is called ok, degraded or lost");
  b.number("window_m", o.window, positive, "m", "scans of so many metres are judged together");
  b.number("lost_window_m", o.lostWindow, positive, "m", "over so many before it is called lost");
  b.number("min_evidence", o.minEvidence, positive, "",
           "sum of confidences below which matches say nothing");
  b.number("lost_evidence", o.lostEvidence, positive, "",
           "lost: only with this sum of confidences in the longer window");
  b.number("lost_share", o.lostShare, share, "share",
           "lost: fewer of the observed poles stand on the map");
  b.number("degraded_share", o.degradedShare, share, "share", "degraded: fewer than this");
  b.number("lost_spread_m", o.lostSpread, positive, "m",
           "lost: greater standard deviation of the position");
  b.number("degraded_spread_m", o.degradedSpread, positive, "m", "degraded: greater than this");
  b.angleDeg("degraded_heading_deg", o.degradedHeading, {0, 180, true, false},
             "degraded: greater standard deviation of the heading");
  b.number("innovation", o.innovation, positive, "",
           "degraded: greater mean squared Mahalanobis distance per degree of freedom");
  b.number("mode_share", o.modeShare, share, "share",
           "degraded: less of the particles' weight in the likeliest place");
  b.number("blind_s", o.blindSeconds, positive, "s", "degraded: no pole for longer");
  b.number("blind_m", o.blindMetres, positive, "m", "degraded: no pole for farther");
  b.number("max_gap_s", o.maxGap, positive, "s", "degraded: a longer time between two scans");
  b.number("confirm_m", o.confirm, Range::atLeast(0), "m",
           "metres of good matches until a new pose is ok");
  b.number("confirm_found_m", o.confirmFound, Range::atLeast(0), "m",
           "likewise of a pose that a search found");
  b.number("confirm_share", o.confirmShare, share, "share",
           "a new pose is borne out by so many matches");
  b.number("confirm_within_m", o.confirmWithin, positive, "m",
           "lost: a new pose not borne out after so many metres");
  b.check(o);
}

void bind(Binder& b, TrackingOptions& o) {
  b.section("tracking", "What of the detections the filter is given");
  b.flag("average", o.average,
         "true: detections of a pole are averaged and used together; false: each for itself");
  b.integer("min_hits", o.minHits, Range::atLeast(1), "", "poles seen less often are not used");
  b.number("every_m", o.every, Range::atLeast(0), "m", "metres until a pole is used again");
  b.choice<Cadence>(
      "cadence", o.cadence, {{Cadence::scan, "scan"}, {Cadence::section, "section"}},
      "detections are used at every scan, or those of the middle scan of each section "
      "at its end (first implementation)");
  b.number("section_length_m", o.localMaps.sectionLength, positive, "m",
           "cadence = section: length of a section");
  b.integer("local_maps", o.localMaps.maps, Range::atLeast(1), "",
            "cadence = section: newest sections that confirm poles");
  b.integer("local_hits", o.localMaps.minHits, Range::atLeast(1), "",
            "cadence = section: overlapping poles in them that a pole needs, itself included");
  b.check(o);
}

void bind(Binder& b, OdometryMonitorOptions& o) {
  b.section("odometry_monitor",
            "Do the poles contradict the odometry? Then their motion replaces it");
  b.flag("enabled", o.enabled, "false: the odometry is always believed");
  b.number("window_s", o.window, positive, "s", "longest time over which scans are compared");
  b.number("scale", o.scale, {0, 1, false, true}, "",
           "tolerated error of the odometry, share of the way");
  b.number("tolerance_m", o.metres, Range::atLeast(0), "m", "tolerated beside it");
  b.angleDeg("tolerance_deg", o.turn, Range::between(0, 180), "tolerated error of a turn");
  b.number("sigmas", o.sigmas, positive, "",
           "so many standard deviations beyond the tolerance contradict");
  b.integer("min_pairs", o.minPairs, Range::atLeast(3), "", "fewer poles in common say nothing");
  b.number("min_share", o.minShare, share, "share", "least share of the poles in common");
  b.number("margin", o.margin, Range::atLeast(0), "poles",
           "so much better must another motion fit");
  b.number("settle_s", o.settle, positive, "s", "agreement until the odometry is believed again");
  b.number("hold_s", o.hold, Range::atLeast(0), "s", "the last speed is kept without poles");
  b.number("max_speed_m_s", o.maxSpeed, positive, "m/s", "no vehicle is faster");
  b.angleDeg("max_turn_rate_deg_s", o.maxTurnRate, positive, "deg/s: or turns faster");
  b.number("sigma_m", o.alignment.sigma, {0, 1, true, false}, "m",
           "added to each detection's standard deviation");
  b.number("gate", o.alignment.gate, positive, "", "greatest Mahalanobis distance of a pair");
  b.number("reach_m", o.alignment.reach, positive, "m", "greatest distance of a pair at first");
  b.check(o);
}

void bind(Binder& b, SearchOptions& o) {
  b.section("search", "When the whole map is searched for the vehicle");
  b.flag("recover", o.recover, "true: a vehicle that is lost is looked for");
  b.number("every_m", o.every, positive, "m", "metres driven between two searches");
  b.number("every_s", o.everySeconds, positive, "s", "or so long, standing still");
  b.number("patience_m", o.patience, Range::atLeast(0), "m",
           "several likely places are taken up after so many metres");
  b.integer("particles", o.particles, Range::between(1, 1000000), "",
            "drawn round the places that were found");
  b.check(o);
}

}  // namespace polemcl
