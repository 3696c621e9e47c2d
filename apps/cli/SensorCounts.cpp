#include "cli/SensorCounts.h"

#include <ostream>

#include "core/common/Angles.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

/// Beyond this, poses or clocks of two LiDARs contradict each other, in standard deviations: their
/// covariances are right within a factor of two.
constexpr double kDisagreement = 3;

void print(std::ostream& out, const LidarCounts& lidar) {
  out << "LiDAR " << lidar.label << ": " << lidar.scans << " scans, missing " << lidar.missing
      << " times";
  if (lidar.late > 0) out << ", " << lidar.late << " dropped that came too late";
  if (lidar.shared > 0)
    out << "; " << lidar.shared << " poles that others saw, " << io::fixed(lidar.apart, 3)
        << " m apart (rms, " << io::fixed(lidar.apartSigmas, 1) << " sigma)";
  out << '\n';
  if (lidar.apartSigmas > kDisagreement)
    out << "LiDAR " << lidar.label
        << " disagrees with the others: check pose and clock_offset_s in "
        << "[sensor:" << lidar.label << "]\n";
}

}  // namespace

std::vector<std::string> turnDoubts(const SequenceCounts& counts, const ScanTiming& timing) {
  std::vector<std::string> doubts;
  for (const auto& [label, turn] : counts.untoldTurns)
    doubts.push_back("scans of " + (label.empty() ? "the LiDAR" : label) +
                     (turn.hasSetCut ? " are not cut at one azimuth" : " look raw") +
                     ": their points are in the order of measuring, " + name(turn.turn) +
                     ", and begin up to " + io::fixed(turn.arc / degree, 0) +
                     " deg apart; set [sensor] turn = " + name(turn.turn) +
                     ", moving_cut = true to correct them for the motion during a turn, or turn = "
                     "compensated if they are corrected");
  if (counts.unorderedScans > 0)
    doubts.push_back(std::to_string(counts.unorderedScans) + " of its " +
                     std::to_string(counts.scans) +
                     " scans are not used: their points are not in the order of measuring, so "
                     "moving_cut = true finds no begin of the scan");
  const bool isSet = timing.turn != Turn::automatic && counts.lidars.empty();
  if (isSet && counts.storedScans > 0 && counts.poles > 0 && timing.known() != counts.storedTurn)
    doubts.push_back(
        std::string("its poles were extracted ") +
        (counts.storedTurn ? "with a turn of the LiDAR" : "without a turn of the LiDAR") +
        ", so [sensor] turn = " + name(timing.turn) +
        " does nothing here: extract them from the scans again");
  return doubts;
}

void printSensors(std::ostream& out, const SequenceCounts& counts) {
  for (const LidarCounts& lidar : counts.lidars) print(out, lidar);
  for (const std::string& label : counts.otherOdometry)
    out << "odometry of a second sensor, not used: " << label << '\n';
  if (counts.otherSensors == 0) return;
  out << "scans of other sensors, not used: " << counts.otherSensors << " (";
  bool first = true;
  for (const std::string& label : counts.otherLabels) {
    out << (first ? "" : ", ") << label;
    first = false;
  }
  out << "); [vehicle] lidars lists the sensor labels to use\n";
}

Json lidarsJson(const SequenceCounts& counts) {
  Json list = Json::array();
  for (const LidarCounts& lidar : counts.lidars)
    list.push_back({{"label", lidar.label},
                    {"scans", lidar.scans},
                    {"missing", lidar.missing},
                    {"late", lidar.late},
                    {"shared_poles", lidar.shared},
                    {"apart_m", lidar.apart},
                    {"apart_sigmas", lidar.apartSigmas}});
  return list;
}

}  // namespace polemcl::apps
