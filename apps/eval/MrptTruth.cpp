#include "eval/MrptTruth.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "io/data/Trajectory.h"
#include "io/file/AtomicFile.h"

namespace polemcl::apps {

void writeMrptTruth(const std::filesystem::path& tum, const std::filesystem::path& output) {
  const auto poses = io::readPlanarTum(tum);
  const auto isWhole = [](const StampedPose2D& pose) { return pose.time == std::floor(pose.time); };
  const auto first = std::adjacent_find(
      poses.begin(), poses.end(),
      [&](const auto& pose, const auto& next) { return !isWhole(pose) && !isWhole(next); });
  if (first == poses.end())
    throw Error(tum.string() +
                ": two successive times that are no whole seconds are needed: "
                "pf-localization takes whole ones for indices");
  std::ostringstream rows;
  rows.precision(9);
  rows << std::fixed;
  for (auto pose = first; pose != poses.end(); ++pose)
    rows << pose->time << ' ' << pose->pose.x << ' ' << pose->pose.y << ' ' << pose->pose.yaw
         << '\n';
  io::writeFile(output, rows.str());
}

}  // namespace polemcl::apps
