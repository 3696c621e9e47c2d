#include "map/TimingDoubt.h"

#include <cmath>

#include "core/common/Angles.h"
#include "core/common/Transform.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

constexpr double kLeastOffset = 0.02;  ///< s; what is found without one is up to 0.01 s

TimedScan timedScan(const SessionScan& scan) {
  TimedScan result{scan.time, scan.pose_map_robot, {}};
  for (const PoleDetection& pole : scan.poles_robot) {
    const Pose2D seen = relative(scan.pose_robot_sensor, {pole.x, pole.y, 0});
    result.poles_robot.push_back({pole.x, pole.y, std::atan2(seen.y, seen.x)});
  }
  return result;
}

std::vector<TimedScan> timedScans(const MappingSession& drive) {
  std::vector<TimedScan> scans;
  for (const SessionScan& scan : drive.scans) scans.push_back(timedScan(scan));
  return scans;
}

std::string errors(double significance) {
  return " (" + io::fixed(significance, 1) + " standard errors)";
}

}  // namespace

TimingEstimate remainingTiming(const MappingSession& drive, double turnSeconds) {
  TimingEstimate result = searchTiming(timedScans(drive), turnSeconds);
  if (drive.filled.all) result.timing.clock = 0;
  return result;
}

std::string timingDoubt(const TimingEstimate& dead, const TimingEstimate& mapped,
                        const ScanTiming& timing, bool looksRaw) {
  if (std::abs(dead.timing.clock) >= kLeastOffset)
    return "the clocks of scans and of odometry or true poses differ: its poles fit better with "
           "[sensor] "
           "clock_offset_s = " +
           io::fixed(timing.clock + dead.timing.clock, 2) + errors(dead.clockSignificance) +
           (std::abs(dead.timing.clock) < kGreatestClock - 1e-6
                ? ""
                : ", or one still farther off: set it and build again");
  const TimingEstimate& found = dead.timing.known() ? dead : mapped;
  if (!found.timing.known() || looksRaw) return {};
  const std::string doubt = "its scans do not look corrected for the motion during a turn" +
                            errors(found.turnSignificance) + ": ";
  const std::string corrected = "check turn, cut_deg, turn_s and the times of the scans";
  if (timing.known()) return doubt + corrected;
  return doubt +
         "if nothing corrected them, set [sensor] turn, and cut_deg or moving_cut, as pole-extract "
         "--inspect finds them in the scans, and extract the poles again (by the poles "
         "alone, turn = " +
         name(found.timing.turn) +
         " fits best; they do not tell whether each scan was cut at one azimuth); if the rawlog "
         "states a turn, " +
         corrected;
}

/// Clocks are searched only on a suspicion: it takes much longer.
std::string timingDoubtOfTruth(const MappingSession& drive, const ScanTiming& timing) {
  if (!searchTiming(timedScans(drive), timing.seconds, {}, false).timing.known()) return {};
  return timingDoubt(remainingTiming(drive, timing.seconds), {}, timing, drive.looksRaw);
}

}  // namespace polemcl::apps
