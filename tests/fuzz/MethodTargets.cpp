#include <cmath>
#include <cstring>

#include <polemcl/core/extraction/PoleExtractor.h>
#include <polemcl/localizer/Localizer.h>
#include <polemcl/mrpt/map/CPoleMap.h>
#include "core/global_localization/GlobalLocalizer.h"
#include "core/localization/LocalSubmap.h"
#include "core/mapping/DriveAdjustment.h"
#include "core/slam/DriveMapping.h"
#include "fuzz/Fuzz.h"
#include "localizer/SettingsValues.h"
#include "mrpt/filter/LocalizationPipeline.h"
#include "support/Poles.h"

namespace polemcl::fuzz {
namespace {

/// A number from -100 to 100 out of two bytes, m; of the highest ones, any float at all. Uniform
/// floats are huge or tiny most of the time.
double place(Numbers& numbers) {
  const unsigned value = numbers.byte() | numbers.byte() << 8;
  return value >= 65000 ? static_cast<double>(numbers.real()) : value / 325.0 - 100;
}

PoleExtractor extractorOf(ExtractionMethod method) {
  SensorOptions sensor;
  sensor.model = "vlp16";
  ExtractionOptions extraction;
  extraction.method = method;
  return PoleExtractor(sensor, extraction);
}

void extract(std::string_view bytes) {
  static PoleExtractor extractors[] = {extractorOf(ExtractionMethod::rangeImage),
                                       extractorOf(ExtractionMethod::scanLine)};
  Numbers numbers(bytes);
  const unsigned head = numbers.byte();
  std::vector<float> x, y, z;
  while (!numbers.atEnd() && x.size() < 20000)
    for (auto* axis : {&x, &y, &z})
      axis->push_back(head % 4 < 2 ? static_cast<float>(place(numbers)) : numbers.real());
  extractors[head % 2].extract({x.data(), y.data(), z.data(), x.size()});
}

/// Walls of points on rings, as a LiDAR has them, with a post in front.
std::string ringsOfPoints() {
  std::string bytes(1, '\3');
  for (int ring = 0; ring < 16; ++ring)
    for (int column = 0; column < 60; ++column) {
      const double elevation = (2 * ring - 15) * M_PI / 180, azimuth = column * 0.2 * M_PI / 180;
      const double range = column / 3 == 8 ? 8 : 15;
      for (const double value :
           {range * std::cos(azimuth), range * std::sin(azimuth), range * std::tan(elevation)}) {
        const auto number = static_cast<float>(value);
        bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
      }
    }
  return bytes;
}

template <class Pole>
Pole arbitraryPole(Numbers& numbers) {
  Pole pole;
  const unsigned head = numbers.byte();
  pole.x = place(numbers);
  pole.y = place(numbers);
  pole.radius = head % 2 == 0 ? 0.1 : place(numbers);
  pole.top = head % 4 < 2 ? 4 : place(numbers);
  if (head % 8 >= 4) {
    const double xx = place(numbers), xy = place(numbers), yy = place(numbers);
    pole.covariance << xx, xy, xy, yy;
  }
  return pole;
}

template <class Pole>
std::vector<Pole> arbitraryPoles(Numbers& numbers, unsigned most) {
  std::vector<Pole> poles;
  for (unsigned left = numbers.byte() % most; left > 0; --left)
    poles.push_back(arbitraryPole<Pole>(numbers));
  return poles;
}

Pose2D arbitraryMotion(Numbers& numbers) {
  return {place(numbers) / 20, place(numbers) / 50, place(numbers) / 100};
}

void search(std::string_view bytes) {
  Numbers numbers(bytes);
  const GlobalLocalizer localizer(arbitraryPoles<MapPole>(numbers, 60));
  LocalSubmap submap;
  for (int i = 0; i < 10 && !numbers.atEnd(); ++i)
    submap.add(arbitraryMotion(numbers), arbitraryPoles<PoleDetection>(numbers, 20));
  localizer.localize(submap);
}

void adjust(std::string_view bytes) {
  Numbers numbers(bytes);
  const bool hasMap = numbers.byte() % 2 == 0;
  std::vector<MapPole> map;
  if (hasMap) map = arbitraryPoles<MapPole>(numbers, 12);
  DrivesToMap drives;
  drives.names = {"a", "b", "c", "d", "e", "f", "g", "h"};
  Pose2D pose;
  for (int i = 0; i < 8 && !numbers.atEnd(); ++i) {
    DrivenScan scan;
    const Pose2D motion = arbitraryMotion(numbers);
    if (numbers.byte() % 8 != 0)
      scan.motion = PoseWithCovariance{motion, Eigen::Matrix3d::Identity() * 0.01};
    pose = compose(pose, motion);
    scan.pose_map_robot = pose;
    scan.poles_robot = arbitraryPoles<PoleDetection>(numbers, 10);
    drives.scans.push_back(scan);
  }
  if (drives.scans.empty()) return;
  drives.scans.front().motion.reset();
  if (hasMap)
    adjustDrives(drives.scans, map, {});
  else
    mapDrives(drives, {});
}

void localize(std::string_view bytes) {
  static const auto map = [] {
    auto poles = std::make_shared<CPoleMap>();
    std::vector<MapPole> all;
    for (int i = 0; i < 40; ++i)
      all.push_back(tests::mapPoleAt(9.0 * (i / 2) + i % 2 * 4, i % 2 == 0 ? 6 : -7));
    poles->setPoles(all);
    return poles;
  }();
  static const Settings settings = [] {
    Settings some;
    some.set("filter.particles=50");
    some.set("start.particles=50");
    return some;
  }();
  Numbers numbers(bytes);
  Localizer localizer(settings, LocalizationMap{map}, 1);
  if (numbers.byte() % 2 == 0)
    localizer.startAnywhere();
  else
    localizer.start({place(numbers), place(numbers), place(numbers)});
  for (int i = 0; i < 8 && !numbers.atEnd(); ++i) {
    PoleScan scan;
    scan.time = numbers.byte() % 8 == 0 ? place(numbers) : i;
    if (i > 0 && numbers.byte() % 8 != 0) {
      PoseWithCovariance motion{arbitraryMotion(numbers), Eigen::Matrix3d::Identity() * 0.01};
      if (numbers.byte() % 8 == 0) motion.covariance(0, 1) = place(numbers);
      scan.motion = motion;
    }
    scan.poles_robot = arbitraryPoles<PoleDetection>(numbers, 20);
    localizer.step(scan);
  }
}

std::vector<std::string> poleSeeds() {
  std::string row;
  for (int i = 0; i < 400; ++i) row += static_cast<char>(i * i * 7 + i / 3);
  return {row, std::string(200, '\x11') + row};
}

}  // namespace

std::vector<Target> methodTargets() {
  const auto clouds = [] { return std::vector<std::string>{ringsOfPoints()}; };
  return {{"extraction", extract, clouds},
          {"search", search, poleSeeds},
          {"adjustment", adjust, poleSeeds},
          {"localizer", localize, poleSeeds}};
}

}  // namespace polemcl::fuzz
