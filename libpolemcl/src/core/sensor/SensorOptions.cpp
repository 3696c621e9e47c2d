#include <algorithm>
#include <cmath>

#include <polemcl/core/sensor/SensorOptions.h>
#include "core/common/Binder.h"
#include "core/sensor/SensorKeys.h"
#include "core/sensor/SensorModel.h"

namespace polemcl {
namespace {

/// Rings are looked up by the tangent of their elevation.
const Range kElevation = Range::between(-89, 89);

void requireTable(const Binder& b, const SensorOptions& o) {
  b.require(o.elevations.size() >= 2, "elevations_deg", static_cast<double>(o.elevations.size()),
            "a list of at least 2 rings where model = table (the value is their number)");
  if (o.lowerElevations.empty() || o.elevations.empty()) return;
  b.require(o.lowerElevations.size() >= 2, "lower_elevations_deg", "1 ring",
            "a list of at least 2 rings, or an empty one");
  b.require(*std::max_element(o.lowerElevations.begin(), o.lowerElevations.end()) <
                *std::min_element(o.elevations.begin(), o.elevations.end()),
            "lower_elevations_deg", "(list)", "a block below all of elevations_deg");
}

}  // namespace

double ScanTiming::offset(double azimuth) const {
  if (!known()) return clock;
  double turned = (azimuth - cut) / (2 * M_PI);
  if (turn == Turn::clockwise) turned = -turned;
  return clock + seconds * (turned - std::floor(turned) - stamp);
}

double ScanTiming::turnRate() const {
  if (!known()) return 0;
  return (turn == Turn::clockwise ? -2 : 2) * M_PI / seconds;
}

const std::vector<std::pair<Turn, std::string>>& turnNames() {
  static const std::vector<std::pair<Turn, std::string>> names{
      {Turn::automatic, "auto"},
      {Turn::compensated, "compensated"},
      {Turn::clockwise, "clockwise"},
      {Turn::counterclockwise, "counterclockwise"}};
  return names;
}

const std::string& name(Turn turn) {
  return turnNames().at(static_cast<std::size_t>(turn)).second;
}

void bindTiming(Binder& b, ScanTiming& timing) {
  b.choice("turn", timing.turn, turnNames(),
           "how the LiDAR turns while it measures a scan, seen from above; compensated: the scans "
           "are already corrected for motion; auto: as the rawlog says, else compensated");
  b.number("turn_s", timing.seconds, Range::between(0.001, 10), "s", "duration of a turn");
  b.angleDeg("cut_deg", timing.cut, Range::between(-360, 360),
             "azimuth at which a scan begins and ends, frame of the clouds");
  b.number("stamp_turn", timing.stamp, Range::between(0, 1), "turns",
           "moment of the time stamp: 0 begin of the turn, 1 end of it");
  b.tier(Tier::tuning);
  b.flag("moving_cut", timing.movingCut,
         "each scan begins at the azimuth of its first point, not at cut_deg: for clouds in the "
         "order of measuring whose begin moves");
  b.number("clock_offset_s", timing.clock, Range::between(-1, 1), "s",
           "added to the time stamps of scans, where odometry and truth have another clock");
}

void bind(Binder& b, SensorOptions& o) {
  b.section("sensor", "The LiDAR and how it is mounted", Tier::sensor);
  bindKeys(b, o);
}

void bindKeys(Binder& b, SensorOptions& o) {
  b.choice("model", o.model, SensorModel::modelNames(),
           "rings of a data sheet, of elevations_deg, or evenly from fov_up_deg to fov_down_deg");
  b.flag("upside_down", o.upsideDown, "true: the elevations of the model change sign");
  b.anglesDeg("elevations_deg", o.elevations, kElevation, "rings of model = table");
  b.anglesDeg("lower_elevations_deg", o.lowerElevations, kElevation,
              "lower block of model = table, for sensors with two blocks");
  b.numbers("apex_m", {&o.upperApex, &o.lowerApex}, Range::any(), "m",
            "heights above the origin where the beams of elevations_deg and of "
            "lower_elevations_deg start");
  b.integer("rings", o.rings, Range::between(2, 1024), "", "number of rings of model = uniform");
  b.angleDeg("fov_up_deg", o.fovUp, kElevation, "topmost ring of model = uniform");
  b.angleDeg("fov_down_deg", o.fovDown, kElevation, "lowest ring of model = uniform");
  b.integer("columns", o.columns, Range::between(0, 65536), "",
            "firing steps of a turn; 0: those of the model");
  b.number("height_m", o.height, Range::between(0, 100), "m", "optical centre above ground");
  b.numbers("origin", {&o.originX, &o.originY, &o.originZ}, Range::any(), "m",
            "optical centre x y z, along the robot's axes from the origin of the clouds");
  b.number("min_range_m", o.minRange, Range::atLeast(0), "m", "nearer returns are the vehicle");
  b.number("max_range_m", o.maxRange, Range::above(0), "m", "farther returns are not used");
  b.flag("check_beams", o.checkBeams,
         "true: a scan that contradicts the settings above is refused; the first three are "
         "checked");
  bindTiming(b, o.timing);
  b.number("range_offset_m", o.rangeOffset, Range::between(-0.5, 0.5), "m",
           "added to the distance of each pole: what the LiDAR measures too short");
  b.number("range_scale", o.rangeScale, Range::between(0.9, 1.1), "",
           "the distance of each pole is multiplied by this first");

  if (o.model == "table") requireTable(b, o);
  if (o.model == "uniform")
    b.require(o.fovUp > o.fovDown, "fov_up_deg", o.fovUp * 180 / M_PI,
              "more than fov_down_deg (negative below the horizon)");
  if (o.model == "table" || o.model == "uniform")
    b.require(o.columns >= 90, "columns", o.columns, "at least 90 where model = " + o.model);
  b.require(o.columns == 0 || o.columns >= 90, "columns", o.columns,
            "0 for those of the model, or at least 90");
  b.require(o.maxRange > o.minRange, "max_range_m", o.maxRange, "more than min_range_m");
}

}  // namespace polemcl
