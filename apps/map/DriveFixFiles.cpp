#include "map/DriveFixFiles.h"

#include <algorithm>
#include <cmath>

#include <polemcl/core/common/Types.h>
#include "cli/Projections.h"
#include "core/common/Statistics.h"
#include "io/file/CsvTable.h"
#include "io/file/TextFile.h"
#include "mrpt/rawlog/GnssFixes.h"

namespace polemcl::apps {
namespace {

constexpr double kFixesWithin = 5e4;  ///< m, of a drive from its middle, and of this from the datum
/// m: over a longer way between two scans, nobody knows where the vehicle was in 2 s or more.
constexpr double kShortWay = 10;

using PathPlace = std::vector<StampedPose2D>::const_iterator;

/// The first scan after the fix; the end where no scan is before it or after it.
PathPlace scanAfter(const GnssFix& fix, const MappingSession& drive) {
  const auto next =
      std::upper_bound(drive.path.begin(), drive.path.end(), fix.time,
                       [](double time, const StampedPose2D& pose) { return time < pose.time; });
  return next == drive.path.begin() ? drive.path.end() : next;
}

/// Two scans between which a place cannot be told.
bool areApart(const StampedPose2D& before, const StampedPose2D& next) {
  return next.time - before.time > longestTruthGap &&
         std::hypot(next.pose.x - before.pose.x, next.pose.y - before.pose.y) > kShortWay;
}

/// The scan before the fix, and how far it is on the way to the next one.
DriveFix between(const GnssFix& fix, const MappingSession& drive, PathPlace next) {
  const auto before = std::prev(next);
  DriveFix placed;
  placed.time = fix.time;
  placed.scan = static_cast<std::size_t>(before - drive.path.begin());
  placed.share = (fix.time - before->time) / (next->time - before->time);
  placed.sigma = fix.sigma;
  placed.antenna_robot = fix.antenna_robot;
  return placed;
}

/// The datum of the median latitude and longitude. \param fixes At least one.
io::Datum middleOf(const std::vector<GnssFix>& fixes) {
  std::vector<double> latitudes, longitudes;
  for (const GnssFix& fix : fixes) {
    latitudes.push_back(fix.latitude);
    longitudes.push_back(fix.longitude);
  }
  const std::size_t half = fixes.size() / 2;
  return {elementOfRank(latitudes, half), elementOfRank(longitudes, half), 0};
}

/// Without those that no drive can explain: what receivers tell before they know anything.
std::vector<GnssFix> withoutGlitches(std::vector<GnssFix> fixes) {
  if (fixes.empty()) return fixes;
  const MapPlane plane(middleOf(fixes));
  const auto isFar = [&](const GnssFix& fix) {
    return plane.distanceTo({fix.longitude, fix.latitude}) > kFixesWithin;
  };
  fixes.erase(std::remove_if(fixes.begin(), fixes.end(), isFar), fixes.end());
  return fixes;
}

std::vector<GnssFix> fixesOf(const MapBuildJob& job, std::size_t i) {
  if (!job.gnss.empty()) return withoutGlitches(readGnssCsv(job.gnss[i]));
  if (!job.gnssOfRawlogs) return {};
  return withoutGlitches(readGnssFixes(job.inputs[i].string(), job.allowTruncated));
}

void requireNear(const io::Datum& datum, const GnssFix& fix, const std::filesystem::path& file,
                 const char* without) {
  const double distance = MapPlane(datum).distanceTo({fix.longitude, fix.latitude});
  if (distance <= kFixesWithin) return;
  throw Error(file.string() + ": its positions from satellites are " +
              io::fixed(distance / 1000, 0) + " km from the datum " + io::datumText(datum) +
              " of the map; are they of this place? Without them: " + without);
}

[[noreturn]] void refuseTable(const std::filesystem::path& file, const MappingSession& drive,
                              std::size_t apart) {
  if (apart > 0)
    throw Error(file.string() + ": all " + std::to_string(apart) +
                " of its positions in the time of the rawlog lie between scans more than 2 s and "
                "10 m apart; use more of the scans, or leave out --gnss");
  throw Error(file.string() + ": none of its times is within those of the rawlog (" +
              io::fixed(drive.path.front().time, 3) + " to " +
              io::fixed(drive.path.back().time, 3) + " s)");
}

/// \throws Error when a column is beyond its limit.
void require(bool right, const io::CsvTable& table, std::size_t row, const char* what) {
  if (!right) throw Error(table.at(row) + what);
}

}  // namespace

std::vector<GnssFix> readGnssCsv(const std::filesystem::path& file) {
  const io::CsvTable table(file);
  const std::size_t time = table.column("time"), latitude = table.column("latitude"),
                    longitude = table.column("longitude"), sigma = table.column("sigma");
  const auto x = table.find("antenna_x"), y = table.find("antenna_y");
  std::vector<GnssFix> fixes;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    GnssFix fix;
    fix.time = table.number(row, time);
    fix.latitude = table.number(row, latitude);
    fix.longitude = table.number(row, longitude);
    fix.sigma = table.number(row, sigma);
    if (x) fix.antenna_robot.x() = table.number(row, *x);
    if (y) fix.antenna_robot.y() = table.number(row, *y);
    require(isOnGlobe(fix), table, row,
            "latitude must be within -90 and 90 deg, longitude within -180 and 180");
    require(fix.sigma > 0, table, row, "sigma must be above 0 m");
    require(fixes.empty() || fix.time >= fixes.back().time, table, row,
            "time goes back; fixes must come in order");
    fixes.push_back(fix);
  }
  return fixes;
}

ReadFixes readDriveFixes(const MapBuildJob& job, const std::vector<MappingSession>& drives,
                         std::size_t firstScan, std::optional<io::Datum>& datum) {
  ReadFixes read;
  std::vector<DriveFix>& fixes = read.fixes;
  std::optional<MapPlane> plane;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const std::size_t known = fixes.size();
    read.apart.push_back(0);
    const bool table = !job.gnss.empty();
    const auto& file = table ? job.gnss[i] : job.inputs[i];
    for (const GnssFix& fix : fixesOf(job, i)) {
      const auto next = scanAfter(fix, drives[i]);
      if (next == drives[i].path.end()) continue;
      if (areApart(*std::prev(next), *next)) {
        ++read.apart.back();
        continue;
      }
      if (!datum) datum = io::Datum{fix.latitude, fix.longitude, 0};
      if (fixes.size() == known)
        requireNear(*datum, fix, file, table ? "leave out --gnss" : "--no-gnss");
      DriveFix placed = between(fix, drives[i], next);
      placed.scan += firstScan;
      if (!plane) plane.emplace(*datum);
      placed.position = plane->place({fix.longitude, fix.latitude});
      fixes.push_back(placed);
    }
    if (table && fixes.size() == known) refuseTable(file, drives[i], read.apart.back());
    firstScan += drives[i].scans.size();
  }
  return read;
}

}  // namespace polemcl::apps
