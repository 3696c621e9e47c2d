#include "localize/GnssStart.h"

#include <cmath>

#include "cli/MapPlane.h"
#include "io/file/TextFile.h"
#include "mrpt/rawlog/GnssFixes.h"

namespace polemcl::apps {
namespace {

constexpr double kSigmas = 5;
constexpr double kLasting = 10;   ///< m
constexpr double kFastest = 40;   ///< m/s
constexpr double kWithin = 5;     ///< s, of the first scan
constexpr double kNearest = 5e4;  ///< m, of the datum; what lies farther is no fix of this place

/// The fix of this place that is nearest in time to the first scan. Reads no farther than needed.
std::optional<GnssFix> nearestFix(const std::filesystem::path& rawlog, bool allowTruncated,
                                  double firstScan, const MapPlane& plane) {
  std::optional<GnssFix> nearest;
  findGnssFix(rawlog.string(), allowTruncated, [&](const GnssFix& fix) {
    if (plane.distanceTo({fix.longitude, fix.latitude}) > kNearest) return false;
    if (!nearest || std::abs(fix.time - firstScan) < std::abs(nearest->time - firstScan))
      nearest = fix;
    return fix.time > firstScan + kWithin;
  });
  return nearest;
}

}  // namespace

SearchArea gnssStart(const std::filesystem::path& rawlog, bool allowTruncated, double firstScan,
                     const io::Datum& datum) {
  const MapPlane plane(datum);
  const auto fix = nearestFix(rawlog, allowTruncated, firstScan, plane);
  if (!fix)
    throw Error(rawlog.string() +
                ": holds no position from satellites (CObservationGPS with GGA) "
                "within 50 km of the map's datum " +
                io::datumText(datum) + ": start with --start or --global");
  const double apart = std::abs(fix->time - firstScan);
  if (apart > kWithin)
    throw Error(rawlog.string() + ": its nearest position from satellites is " +
                io::fixed(apart, 1) + " s from the first scan, at most " + io::fixed(kWithin, 0) +
                " s are allowed: start with --start or --global");
  SearchArea area;
  area.centre_map = plane.place({fix->longitude, fix->latitude});
  area.radius = kSigmas * fix->sigma + kLasting + kFastest * apart + fix->antenna_robot.norm();
  return area;
}

}  // namespace polemcl::apps
