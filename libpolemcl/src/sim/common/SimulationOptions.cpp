#include "sim/common/SimulationOptions.h"

#include "sim/common/SimulationLimits.h"

namespace polemcl::sim {

using limits::require;

void WorldOptions::validate() const {
  require("[world] seed", static_cast<double>(seed), limits::seed);
  require("[world] day", day, limits::day);
  require("[world] length_m", length, limits::length);
  require("[world] curviness", curviness, limits::curviness);
  require("[world] relief", relief, limits::relief);
  require("[world] road_width_m", roadWidth, limits::roadWidth);
  require("[world] lamp_spacing_m", lampSpacing, limits::lampSpacing);
  require("[world] sign_spacing_m", signSpacing, limits::signSpacing);
  require("[world] tree_spacing_m", treeSpacing, limits::treeSpacing);
  require("[world] tree_share", treeShare, limits::share);
  require("[world] parked_share", parkedShare, limits::share);
  require("[world] clutter", clutter, limits::clutter);
  require("[world] removed_share", removedShare, limits::share);
  require("[world] added_share", addedShare, limits::share);
  require("[world] foliage", foliage, limits::foliage);
  require("[world] replaced_per_year", replacedPerYear, limits::replacedPerYear);
  require("[world] day_of_year", dayOfYear, limits::dayOfYear);
  require("[world] snow_bank_m", snowBank, limits::snowBank);
  require("[world] building_sites", buildingSites, limits::buildingSites);
  require("[world] side_streets", sideStreets, limits::sideStreets);
}

void SimulationOptions::validate() const {
  world.validate();
  require("[simulation] spacing_m", spacing, limits::spacing);
  require("[simulation] speed_m_s", speed, limits::speed);
  require("[simulation] odometry_noise", odometryNoise, limits::odometryNoise);
  require("[simulation] scans", scans, limits::scans);
  require("[simulation] drive_seed", static_cast<double>(driveSeed), limits::seed);
  require("[simulation] false_factor", falseFactor, limits::falseFactor);
  require("[simulation] detour", detour, Range::between(0, world.sideStreets));
  // Half the width of a vehicle must fit between sensor and kerb.
  const double room = world.roadWidth / 2 - 1.2;
  require("[simulation] lane_offset_m", laneOffset, Range::between(-room, room));
}

}  // namespace polemcl::sim
