#include <polemcl/core/Types.h>
#include <polemcl/sim/LidarModel.h>
#include <polemcl/sim/SimulationOptions.h>

#include <cmath>
#include <sstream>

namespace polemcl::sim {
namespace {
void require(const char* section, const char* key, double value, double low, double high) {
  if (std::isfinite(value) && value >= low && value <= high) return;
  std::ostringstream message;
  message << '[' << section << "] " << key << " = " << value << ": allowed are " << low << " to "
          << high;
  throw Error(message.str());
}
}  // namespace

void WorldOptions::validate() const {
  require("world", "day", day, 0, 100000);
  require("world", "length_m", length, 20, 100000);
  require("world", "curviness", curviness, 0, 2);
  require("world", "relief", relief, 0, 3);
  require("world", "road_width_m", roadWidth, 6, 20);
  require("world", "lamp_spacing_m", lampSpacing, 8, 1000);
  require("world", "sign_spacing_m", signSpacing, 8, 1000);
  require("world", "tree_share", treeShare, 0, 1);
  require("world", "parked_share", parkedShare, 0, 1);
  require("world", "clutter", clutter, 0, 3);
  require("world", "removed_share", removedShare, 0, 1);
  require("world", "added_share", addedShare, 0, 0.2);
  require("world", "foliage", foliage, 0, 2);
}

void SimulationOptions::validate() const {
  world.validate();
  makeLidar(sensor);
  require("sensor", "height_m", height, 0.3, 5);
  require("simulation", "spacing_m", spacing, 0.05, 50);
  require("simulation", "speed_m_s", speed, 0.1, 50);
  require("simulation", "lane_offset_m", laneOffset, 1.2 - world.roadWidth / 2,
          world.roadWidth / 2 - 1.2);
  require("simulation", "odometry_noise", odometryNoise, 0, 1);
  require("simulation", "scans", scans, 0, 10000000);
}

}  // namespace polemcl::sim
