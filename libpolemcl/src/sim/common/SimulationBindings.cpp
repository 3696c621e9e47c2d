#include "sim/common/SimulationBindings.h"

#include "sim/common/SimulationLimits.h"

namespace polemcl::sim {

void bind(Binder& b, WorldOptions& o) {
  b.section("world", "The simulated street and what stands there");
  b.integer("seed", o.seed, limits::seed, "", "another seed, another street");
  b.integer("day", o.day, limits::day, "", "0: the day of the map; others move what moves");
  b.number("length_m", o.length, limits::length, "m", "of the street, unless a track is given");
  b.text("track", o.track, "poses the road follows, 12 numbers a line, plain or gzip; or empty");
  b.number("curviness", o.curviness, limits::curviness, "", "scales the bends; 0: straight");
  b.number("relief", o.relief, limits::relief, "", "scales slopes and bumps; 0: flat");
  b.number("road_width_m", o.roadWidth, limits::roadWidth, "m", "from kerb to kerb");
  b.number("lamp_spacing_m", o.lampSpacing, limits::lampSpacing, "m", "mean, on each side");
  b.number("sign_spacing_m", o.signSpacing, limits::signSpacing, "m", "mean, on each side");
  b.number("tree_spacing_m", o.treeSpacing, limits::treeSpacing, "m", "mean, where trees line");
  b.number("tree_share", o.treeShare, limits::share, "", "share of the street lined with trees");
  b.number("parked_share", o.parkedShare, limits::share, "", "share of parking places taken");
  b.number("clutter", o.clutter, limits::clutter, "", "scales people, bins, bollards, bicycles");
  b.number("removed_share", o.removedShare, limits::share, "", "poles gone on another day");
  b.number("added_share", o.addedShare, limits::share, "", "poles new on another day");
  b.number("foliage", o.foliage, limits::foliage, "", "density of leaves; 0: bare branches");
  b.number("replaced_per_year", o.replacedPerYear, limits::replacedPerYear, "",
           "poles gone for good after 365 days; as many come");
  b.integer("day_of_year", o.dayOfYear, limits::dayOfYear, "",
            "of day 0, 1: 1 January, leaves and snow follow; 0: no seasons");
  b.number("snow_bank_m", o.snowBank, limits::snowBank, "m",
           "what midwinter's banks along the kerb hide of things there");
  b.number("building_sites", o.buildingSites, limits::buildingSites, "1/km",
           "of street, at any time");
  b.integer("side_streets", o.sideStreets, limits::sideStreets, "", "that detours can take");
  b.flag("people_move", o.peopleMove, "true: people walk during the drive");
  b.check(o);
}

void bind(Binder& b, SimulationOptions& o) {
  b.section("simulation", "The simulated drive");
  b.number("spacing_m", o.spacing, limits::spacing, "m", "distance between scans");
  b.number("speed_m_s", o.speed, limits::speed, "m/s", "of the vehicle");
  b.number("lane_offset_m", o.laneOffset, limits::laneOffset, "m",
           "of the drive from the middle of the road, + left");
  b.number("odometry_noise", o.odometryNoise, limits::odometryNoise, "",
           "standard deviation as a share of each component of the motion");
  b.flag("reverse", o.reverse, "true: from the far end of the street, in the other lane");
  b.flag("motion_distortion", o.motionDistortion, "true: the sensor moves while it turns");
  b.integer("scans", o.scans, limits::scans, "", "at most so many; 0: to the end of the road");
  b.integer("drive_seed", o.driveSeed, limits::seed, "",
            "another one: another drive of the same day, with its own noise");
  b.integer("detour", o.detour, limits::detour, "",
            "goes round through this side street of the world; 0: straight on");
  b.text("detections", o.detections,
         "model of detections (JSON) that `--poles` samples; empty: it casts rays");
  b.number("false_factor", o.falseFactor, limits::falseFactor, "",
           "scales the false detections of that model");
  bind(b, o.world);
  b.section("simulation", "");
  b.check(o);
}

}  // namespace polemcl::sim
