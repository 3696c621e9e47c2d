#include "sim/common/SimulationOptions.h"

#include "core/common/Binder.h"

namespace polemcl::sim {
namespace {

const Range kShareOfSimulation = Range::between(0, 1), kSeedOfSimulation = Range::between(0, 9e15);

void bindSeasons(Binder& b, WorldOptions& o) {
  b.number("replaced_per_year", o.replacedPerYear, Range::between(0, 0.9), "",
           "share of the poles that go for good within 365 days; as many new ones come");
  b.integer("day_of_year", o.dayOfYear, Range::between(0, 365), "",
            "date of day 0 for leaves and snow, 1: 1 January; 0: no seasons");
  b.number("building_sites", o.buildingSites, Range::between(0, 6), "1/km",
           "number of construction sites per km of street");
  b.integer("side_streets", o.sideStreets, Range::between(0, 2), "",
            "number of side streets for detours");
}

}  // namespace

void bind(Binder& b, WorldOptions& o) {
  b.section("world", "The simulated street and what stands there");
  b.integer("seed", o.seed, kSeedOfSimulation, "", "another seed gives another street");
  b.integer("day", o.day, Range::between(0, 36500), "",
            "0: the day of the map; on other days things have moved");
  b.number("length_m", o.length, Range::between(20, 50000), "m",
           "length of the street, unless a track is given");
  b.text("track", o.track,
         "file of poses that the road follows, 12 numbers a line, plain or gzip; or empty");
  b.number("lamp_spacing_m", o.lampSpacing, Range::between(8, 1000), "m",
           "mean distance of lamp posts on each side");
  b.number("sign_spacing_m", o.signSpacing, Range::between(8, 1000), "m",
           "mean distance of traffic signs on each side");
  b.number("tree_spacing_m", o.treeSpacing, Range::between(4, 100), "m",
           "mean distance of trees in a row");
  b.number("tree_share", o.treeShare, kShareOfSimulation, "",
           "share of the street lined with trees");
  b.number("removed_share", o.removedShare, kShareOfSimulation, "",
           "share of the poles that are gone on another day");
  b.number("added_share", o.addedShare, kShareOfSimulation, "",
           "share of the poles new on another day");
  bindSeasons(b, o);
  bind(b, o.realism);
}

void bind(Binder& b, SimulationOptions& o) {
  b.section("simulation", "The simulated drive");
  b.number("spacing_m", o.spacing, Range::between(0.05, 50), "m", "distance between scans");
  b.number("speed_m_s", o.speed, Range::between(0.1, 50), "m/s", "speed of the vehicle");
  b.number("odometry_noise", o.odometryNoise, kShareOfSimulation, "",
           "standard deviation as a share of each component of the motion");
  b.choice<OdometryModel>("odometry", o.odometry,
                          {{OdometryModel::noise, "noise"}, {OdometryModel::wheels, "wheels"}},
                          "true motion with odometry_noise (paper), or wheel ticks and a gyroscope "
                          "with the errors below");
  b.number("odometry_scale", o.odometryBias.scale, Range::between(-0.5, 0.5), "share",
           "error of the distance that stays");
  b.angleDeg("odometry_yaw_deg_m", o.odometryBias.yaw, Range::between(-10, 10),
             "error of the heading that stays, in deg per metre");
  b.flag("reverse", o.reverse, "true: from the far end of the street, in the other lane");
  b.flag("motion_distortion", o.motionDistortion, "true: the sensor moves while it turns");
  b.integer("scans", o.scans, Range::between(0, 1e7), "",
            "greatest number of scans; 0: to the end of the road");
  b.integer("drive_seed", o.driveSeed, kSeedOfSimulation, "",
            "another seed gives another drive of the same day, with its own noise");
  b.integer("detour", o.detour, Range::between(0, 2), "",
            "number of the side street that the drive takes; 0: straight on");
  b.text("detections", o.detections,
         "model of detections (JSON) for `--poles`; empty: rays are cast");
  b.number("false_factor", o.falseFactor, Range::between(0, 10), "",
           "scale of the false detections of that model");
  bind(b, o.world);
  b.section("simulation", "");
  b.require(o.detour <= o.world.sideStreets, "detour", o.detour, "[world] side_streets or less");
}

void WorldOptions::validate() const {
  checkOptions(*this);
}

void SimulationOptions::validate() const {
  checkOptions(*this);
}

}  // namespace polemcl::sim
