// How well poles are found on simulated streets and on a real drive.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <ostream>

#include <polemcl/io/data/Cloud.h>
#include "io/data/Trajectory.h"
#include "support/Clouds.h"
#include "support/KnownScene.h"
#include "support/SimulatedScans.h"

namespace polemcl::test_pole_extractor_on_streets {
namespace {

using namespace polemcl::clouds;

struct Lidar {
  std::string model;
  double height;             ///< above ground, m
  double precision, recall;  ///< of the worlds of precisionAndRecall together, as measured
};
void PrintTo(const Lidar& lidar, std::ostream* out) {
  *out << lidar.model;
}

/// Poles on streets that the classifier was not fitted to (those are worlds 101 to 180). The number
/// of its trees and the least confidence were chosen with these figures at hand.
class PoleExtractorOnStreets : public ::testing::TestWithParam<Lidar> {
 protected:
  PoleExtractor extractor() const {
    SensorOptions sensor;
    sensor.model = GetParam().model;
    sensor.height = GetParam().height;
    return PoleExtractor(sensor, {});
  }
  std::vector<LabelledScan> scans(std::uint64_t world, int count) const {
    return streetScans(world, GetParam().model, GetParam().height, count);
  }
};

/// How many of `poles` are found again in `others`, turned by yaw, within `reach` m.
int foundAgain(const std::vector<PoleDetection>& poles, const std::vector<PoleDetection>& others,
               double yaw, double reach) {
  int found = 0;
  for (const PoleDetection& p : poles) {
    const double c = std::cos(yaw), s = std::sin(yaw);
    found += nearest(others, c * p.x - s * p.y, s * p.x + c * p.y, reach) != nullptr;
  }
  return found;
}

/// Pole positions of every scan of a folder, in the frame of its poses.
std::vector<std::vector<Eigen::Vector2d>> mapEveryScan(const std::filesystem::path& folder) {
  const auto poses = io::readKittiPoses(folder / "poses.txt");
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "velodyne"))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  EXPECT_EQ(files.size(), poses.size());
  PoleExtractor extractor(SensorOptions{}, {});
  std::vector<std::vector<Eigen::Vector2d>> poles;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const io::Cloud cloud = io::readKittiBin(files[i]);
    poles.emplace_back();
    for (const PoleDetection& p : extractor.extract(cloud.view()))
      poles.back().push_back((poses[i] * Eigen::Vector3d(p.x, p.y, 0)).head<2>());
  }
  return poles;
}

TEST_P(PoleExtractorOnStreets, PrecisionAndRecall) {
  PoleExtractor extract = extractor();
  Score all;
  for (const std::uint64_t world : {11, 12, 13, 14, 15, 16, 17, 18}) {
    Score one;
    for (const LabelledScan& s : scans(world, 3)) {
      const auto& poles = extract.extract(s.scan.view());
      one.add(poles, s.poles);
      all.add(poles, s.poles);
    }
    EXPECT_GE(one.precision(), 0.90) << "world " << world;
    EXPECT_GE(one.recall(), 0.70) << "world " << world;
  }
  RecordProperty("precision", std::to_string(all.precision()));
  RecordProperty("recall", std::to_string(all.recall()));
  EXPECT_GT(all.visible, 400);
  EXPECT_GE(all.precision(), GetParam().precision - 0.01) << all.right << " of " << all.detections;
  EXPECT_GE(all.recall(), GetParam().recall - 0.01) << all.found << " of " << all.visible;
}

TEST_P(PoleExtractorOnStreets, TurningTheScanTurnsThePoles) {
  PoleExtractor extract = extractor();
  int poles = 0, found = 0, back = 0, all = 0;
  for (const std::uint64_t world : {11, 12, 13})
    for (const LabelledScan& s : scans(world, 2)) {
      const auto before = extract.extract(s.scan.view());
      for (int degrees = 30; degrees <= 330; degrees += 30) {
        const double yaw = degrees * kDegree;
        const auto& after = extract.extract(turned(s.scan.view(), yaw).view());
        poles += static_cast<int>(before.size());
        found += foundAgain(before, after, yaw, 0.01);
        all += static_cast<int>(after.size());
        back += foundAgain(after, before, -yaw, 0.01);
      }
    }
  RecordProperty("found", std::to_string(static_cast<double>(found) / poles));
  RecordProperty("back", std::to_string(static_cast<double>(back) / all));
  // Sectors and rings of the ground do not turn with the scan: poles at the limit of a height may
  // come or go.
  EXPECT_GE(found, 0.98 * poles) << found << " of " << poles;
  EXPECT_GE(back, 0.97 * all) << back << " of " << all;
}

TEST_P(PoleExtractorOnStreets, ShuffledPointsGiveTheSameBytes) {
  PoleExtractor extract = extractor();
  for (const LabelledScan& s : scans(12, 2)) {
    const auto poles = extract.extract(s.scan.view());
    EXPECT_GT(poles.size(), 5u);
    EXPECT_TRUE(same(poles, extract.extract(shuffled(s.scan.view(), 1).view())));
  }
}

INSTANTIATE_TEST_SUITE_P(Of, PoleExtractorOnStreets,
                         ::testing::Values(Lidar{"hdl32e", 1.0, 0.959, 0.813},
                                           Lidar{"hdl64e", 1.73, 0.973, 0.861},
                                           Lidar{"os1_64", 1.8, 0.959, 0.808},
                                           Lidar{"vlp16", 1.0, 0.983, 0.782}),
                         [](const auto& i) { return i.param.model; });

// A pole is stable when at least 3 of the next 5 scans see it within 0.25 m; the first
// implementation had 11.3 poles a scan, 52.5 % of them stable.
TEST(PoleExtractorOnKitti, PolesAreSeenAgainInTheNextScans) {
  const char* data = std::getenv("POLEMCL_DATA");
  if (!data) GTEST_SKIP() << "POLEMCL_DATA is not set";
  const auto poles = mapEveryScan(std::filesystem::path(data) / "kitti_raw_0005");
  std::size_t all = 0, judged = 0, stable = 0;
  for (const auto& scan : poles) all += scan.size();
  for (std::size_t i = 0; i + 5 < poles.size(); ++i)
    for (const Eigen::Vector2d& p : poles[i]) {
      int again = 0;
      for (std::size_t j = i + 1; j <= i + 5; ++j)
        again += std::any_of(poles[j].begin(), poles[j].end(),
                             [&](const Eigen::Vector2d& q) { return (p - q).norm() < 0.25; });
      ++judged;
      stable += again >= 3;
    }
  const double perScan = static_cast<double>(all) / static_cast<double>(poles.size());
  const double share = static_cast<double>(stable) / static_cast<double>(judged);
  RecordProperty("poles_per_scan", std::to_string(perScan));
  RecordProperty("stable", std::to_string(share));
  EXPECT_GE(perScan, 27.5);  // measured: 28.4 and 0.822
  EXPECT_GE(share, 0.81);
}

}  // namespace
}  // namespace polemcl::test_pole_extractor_on_streets
