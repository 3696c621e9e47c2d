#include "map/DriveFixFiles.h"

#include <algorithm>

#include "io/data/GnssCsv.h"
#include "io/file/TextFile.h"
#include "map/MapPlane.h"
#include "mrpt/rawlog/GnssFixes.h"

namespace polemcl::apps {
namespace {

/// The scan before the fix, and how far it is on the way to the next one.
std::optional<DriveFix> between(const GnssFix& fix, const MappingSession& drive) {
  const auto next =
      std::upper_bound(drive.path.begin(), drive.path.end(), fix.time,
                       [](double time, const StampedPose2D& pose) { return time < pose.time; });
  if (next == drive.path.begin() || next == drive.path.end()) return std::nullopt;
  const auto before = std::prev(next);
  if (next->time - before->time > longestTruthGap) return std::nullopt;
  DriveFix placed;
  placed.time = fix.time;
  placed.scan = static_cast<std::size_t>(before - drive.path.begin());
  placed.share = (fix.time - before->time) / (next->time - before->time);
  placed.sigma = fix.sigma;
  placed.antenna_robot = fix.antenna_robot;
  return placed;
}

}  // namespace

std::vector<DriveFix> readDriveFixes(const MapBuildJob& job,
                                     const std::vector<MappingSession>& drives,
                                     std::size_t firstScan, std::optional<io::Datum>& datum) {
  std::vector<DriveFix> fixes;
  std::optional<MapPlane> plane;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const bool table = !job.gnss.empty();
    const std::size_t known = fixes.size();
    for (const GnssFix& fix : table ? io::readGnssCsv(job.gnss[i])
                                    : readGnssFixes(job.inputs[i].string(), job.allowTruncated)) {
      auto placed = between(fix, drives[i]);
      if (!placed) continue;
      if (!datum) datum = io::Datum{fix.latitude, fix.longitude, 0};
      placed->scan += firstScan;
      if (!plane) plane.emplace(*datum);
      placed->position = plane->place({fix.longitude, fix.latitude});
      fixes.push_back(*placed);
    }
    if (table && fixes.size() == known)
      throw Error(job.gnss[i].string() + ": none of its times is within those of the rawlog (" +
                  io::fixed(drives[i].path.front().time, 3) + " to " +
                  io::fixed(drives[i].path.back().time, 3) + " s)");
    firstScan += drives[i].scans.size();
  }
  return fixes;
}

}  // namespace polemcl::apps
