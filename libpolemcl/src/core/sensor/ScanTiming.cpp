#include <cmath>

#include <polemcl/core/sensor/SensorOptions.h>
#include "core/common/Binder.h"

namespace polemcl {

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
  b.number("turn_s", timing.seconds, Range::aboveUpTo(0, 10), "s", "duration of a turn");
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

}  // namespace polemcl
