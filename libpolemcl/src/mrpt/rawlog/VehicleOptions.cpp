#include "mrpt/rawlog/VehicleOptions.h"

#include <algorithm>
#include <cctype>

#include "core/common/Angles.h"
#include "core/common/Binder.h"
#include "core/extraction/ExtractionKeys.h"
#include "core/sensor/SensorKeys.h"
#include "io/file/TextFile.h"

namespace polemcl {
namespace {

constexpr std::size_t kMostLidars = 64;

bool isName(const std::string& label) {
  return std::all_of(label.begin(), label.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-' || c == '.' || c == '/';
  });
}

/// Names of sections ignore case.
bool sameName(const std::string& a, const std::string& b) {
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](unsigned char x, unsigned char y) {
           return std::tolower(x) == std::tolower(y);
         });
}

std::vector<LidarOptions> lidarsOf(const Binder& b, const std::string& labels,
                                   const VehicleOptions& before, const LidarOptions& common) {
  std::vector<LidarOptions> lidars;
  const auto names = io::wordsOf(labels);
  b.require(names.size() <= kMostLidars, "lidars", static_cast<double>(names.size()),
            "at most " + std::to_string(kMostLidars) + " labels (the value is their number)");
  for (const std::string& label : names) {
    const auto same = [&](const LidarOptions& other) { return sameName(other.label, label); };
    b.require(isName(label), "lidars", labels,
              "a list of sensor labels of letters, digits and _ - . / (" + label + " is not one)");
    b.require(std::none_of(lidars.begin(), lidars.end(), same), "lidars", labels,
              "each label once, small and capital letters being the same");
    const auto known = before.indexOf(label);
    lidars.push_back(known ? before.lidars[*known] : common);
    lidars.back().label = label;
  }
  return lidars;
}

/// Six numbers as in `--sensor-pose`, or none.
void bindPose(Binder& b, std::vector<double>& pose) {
  b.numbers("pose", pose, Range::any(), "",
            "x y z yaw_deg pitch_deg roll_deg of the LiDAR on the vehicle, m and deg; empty: that "
            "of its observations");
  b.require(pose.empty() || pose.size() == 6, "pose", static_cast<double>(pose.size()),
            "six numbers, x y z yaw_deg pitch_deg roll_deg, or none (the value is their number)");
}

}  // namespace

std::optional<std::size_t> VehicleOptions::indexOf(const std::string& label) const {
  for (std::size_t i = 0; i < lidars.size(); ++i)
    if (lidars[i].label == label) return i;
  return std::nullopt;
}

ObservationPoleExtractorOptions LidarOptions::extractor() const {
  ObservationPoleExtractorOptions options{sensor, extraction};
  if (pose.size() == 6)
    options.sensorPose = mrpt::poses::CPose3D(pose[0], pose[1], pose[2], pose[3] * degree,
                                              pose[4] * degree, pose[5] * degree);
  return options;
}

void bind(Binder& b, LidarOptions& lidar) {
  ExtractionOptions& extraction = lidar.extraction;
  b.section("sensor:" + lidar.label, "The LiDAR " + lidar.label + " of [vehicle]", Tier::sensor);
  bindPose(b, lidar.pose);
  bindKeys(b, lidar.sensor);
  b.section("range_image:" + lidar.label, "[range_image] of the LiDAR " + lidar.label,
            Tier::expert);
  bindKeys(b, extraction.rangeImage);
  b.section("scan_line:" + lidar.label, "[scan_line] of the LiDAR " + lidar.label);
  bindKeys(b, extraction.scanLine);
}

void bind(Binder& b, VehicleOptions& vehicle, const SensorOptions& sensor,
          const ExtractionOptions& extraction) {
  b.section("vehicle", "Several LiDARs on one vehicle", Tier::tuning);
  std::vector<std::string> known;
  for (const LidarOptions& lidar : vehicle.lidars) known.push_back(lidar.label);
  std::string labels = io::joined(known, " ");
  b.text("lidars", labels,
         "sensor labels of the LiDARs to use, with blanks between; their poles are fused. Empty: "
         "one LiDAR, that of the first scan");
  vehicle.lidars = lidarsOf(b, labels, vehicle, {"", sensor, extraction});
  b.number("fuse_within_s", vehicle.fuseWithin, Range::between(0, 10), "s",
           "greatest time between scans that are fused: half a turn of the fastest LiDAR");
  b.number("wait_s", vehicle.wait, Range::between(0, 10), "s",
           "longest time by which a scan may come after later scans of other LiDARs; it is not "
           "waited for longer");
  for (LidarOptions& lidar : vehicle.lidars) bind(b, lidar);
}

}  // namespace polemcl
