#include "mrpt/rawlog/GnssFixes.h"

#include <mrpt/core/Clock.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "mrpt/rawlog/RawlogReader.h"

namespace polemcl {

using namespace mrpt::obs;

namespace {

using Gga = gnss::Message_NMEA_GGA;

constexpr double kSingleSigma = 2.5, kDifferentialSigma = 1;  ///< m, for an HDOP of 1; assumed
constexpr double kRtkSigma = 0.02, kFloatRtkSigma = 0.3;      ///< m; assumed

enum Quality {
  kNone = 0,
  kSingle = 1,
  kDifferential = 2,
  kRtk = 4,
  kFloatRtk = 5,
  kReckoned = 6,
  kByHand = 7,
  kSimulated = 8
};

bool isMeasured(const Gga::content_t& gga) {
  return gga.fix_quality != kNone && gga.fix_quality != kReckoned && gga.fix_quality != kByHand &&
         gga.fix_quality != kSimulated;
}

double sigmaOf(const Gga::content_t& gga) {
  const double hdop = gga.thereis_HDOP && gga.HDOP > 0 ? gga.HDOP : 1;
  switch (gga.fix_quality) {
    case kRtk:
      return kRtkSigma;
    case kFloatRtk:
      return kFloatRtkSigma;
    case kDifferential:
      return kDifferentialSigma * hdop;
    default:
      return kSingleSigma * hdop;
  }
}

std::optional<GnssFix> fixOf(const CObservationGPS& observation) {
  if (!observation.hasMsgClass<Gga>()) return std::nullopt;
  const Gga::content_t& gga = observation.getMsgByClass<Gga>().fields;
  if (!isMeasured(gga)) return std::nullopt;
  GnssFix fix;
  fix.time = mrpt::Clock::toDouble(observation.timestamp);
  fix.latitude = gga.latitude_degrees;
  fix.longitude = gga.longitude_degrees;
  fix.sigma = sigmaOf(gga);
  fix.antenna_robot = {observation.sensorPose.x(), observation.sensorPose.y()};
  const bool isUsable = isOnGlobe(fix) && std::isfinite(fix.sigma) && fix.antenna_robot.allFinite();
  return isUsable ? std::optional(fix) : std::nullopt;
}

/// Gives all CObservationGPS that have a time, in the order of the file, until `take` says false.
void forEachGnss(const std::string& rawlog, bool allowTruncated,
                 const std::function<bool(const CObservationGPS::Ptr&)>& take) {
  const auto goesOn = [&](const CObservation::Ptr& observation) {
    const auto gps = std::dynamic_pointer_cast<CObservationGPS>(observation);
    return !gps || gps->timestamp == INVALID_TIMESTAMP || take(gps);
  };
  RawlogReader reader(rawlog, allowTruncated);
  RawlogEntry entry;
  while (reader.next(entry)) {
    if (entry.observation && !goesOn(entry.observation)) return;
    if (entry.frame && !std::all_of(entry.frame->begin(), entry.frame->end(), goesOn)) return;
  }
}

}  // namespace

std::vector<CObservationGPS::Ptr> readGnssObservations(const std::string& rawlog,
                                                       bool allowTruncated) {
  std::vector<CObservationGPS::Ptr> found;
  forEachGnss(rawlog, allowTruncated, [&](const CObservationGPS::Ptr& observation) {
    found.push_back(observation);
    return true;
  });
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a->timestamp < b->timestamp; });
  return found;
}

std::vector<GnssFix> readGnssFixes(const std::string& rawlog, bool allowTruncated) {
  std::vector<GnssFix> fixes;
  for (const auto& observation : readGnssObservations(rawlog, allowTruncated))
    if (const auto fix = fixOf(*observation)) fixes.push_back(*fix);
  return fixes;
}

std::optional<GnssFix> findGnssFix(const std::string& rawlog, bool allowTruncated,
                                   const std::function<bool(const GnssFix&)>& accept) {
  std::optional<GnssFix> found;
  forEachGnss(rawlog, allowTruncated, [&](const CObservationGPS::Ptr& observation) {
    const auto fix = fixOf(*observation);
    if (fix && accept(*fix)) found = fix;
    return !found;
  });
  return found;
}

CObservationGPS::Ptr gnssObservation(const GnssFix& fix) {
  Gga message;
  message.fields.latitude_degrees = fix.latitude;
  message.fields.longitude_degrees = fix.longitude;
  message.fields.fix_quality = kSingle;
  message.fields.thereis_HDOP = true;
  message.fields.HDOP = static_cast<float>(fix.sigma / kSingleSigma);
  auto observation = CObservationGPS::Create();
  observation->sensorLabel = "gnss";
  observation->timestamp = mrpt::Clock::fromDouble(fix.time);
  observation->sensorPose = mrpt::poses::CPose3D(fix.antenna_robot.x(), fix.antenna_robot.y(), 0);
  observation->setMsg(message);
  return observation;
}

}  // namespace polemcl
