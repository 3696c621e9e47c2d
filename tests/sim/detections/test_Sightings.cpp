#include <gtest/gtest.h>

#include <map>

#include "sim/detections/Sightings.h"
#include "sim/world/SightLines.h"

namespace polemcl::test_sightings {
namespace {

using namespace polemcl::sim;

constexpr double kRange = 40;  // m

/// A drive on a flat street; its clouds have their origin at the optical centre.
class Sightings : public testing::Test {
 protected:
  static SimulationOptions options() {
    SimulationOptions options;
    options.world.length = 100;
    options.world.seed = 11;
    options.world.relief = 0;
    options.scans = 60;
    return options;
  }
  Eigen::Vector3d inCloud(std::size_t scan, double x, double y) const {
    const Eigen::Isometry3d& T = drive.drive().T_map_sensor[scan];
    return T.inverse() * Eigen::Vector3d(x, y, T.translation().z());
  }
  /// A detection 3 cm too far and 4 cm to the left of a place, with sigmas of 5 cm.
  PoleDetection detected(std::size_t scan, double x, double y) const {
    const Eigen::Vector2d p = inCloud(scan, x, y).head<2>(), ray = p.normalized();
    PoleDetection detection;
    detection.x = p.x() + 0.03 * ray.x() - 0.04 * ray.y();
    detection.y = p.y() + 0.03 * ray.y() + 0.04 * ray.x();
    detection.covariance = Eigen::Matrix2d::Identity() * 0.0025;
    detection.confidence = 0.75;
    return detection;
  }
  std::map<DetectionClass, std::vector<Sighting>> sightings() const {
    std::map<DetectionClass, std::vector<Sighting>> byKind;
    for (const Sighting& sighting : sightingsOf(drive, poles, kRange))
      byKind[sighting.kind == DetectionClass::clutter || sighting.kind == DetectionClass::passing
                 ? sighting.kind
                 : DetectionClass::lampPost]
          .push_back(sighting);
    return byKind;
  }
  SimulatedDrive drive{options()};
  std::vector<std::vector<PoleDetection>> poles =
      std::vector<std::vector<PoleDetection>>(drive.scans());
};
TEST_F(Sightings, OfPolesAreAllInRangeFoundOrNot) {
  std::size_t found = 0, inRange = 0, hidden = 0;
  const SightLines sight(drive.world());
  for (std::size_t i = 0; i < drive.scans(); ++i) {
    const Eigen::Vector2d sensor = drive.drive().T_map_sensor[i].translation().head<2>();
    const auto blocks = sight.around(sensor, kRange);
    for (const TruePole& pole : drive.world().poles()) {
      const Eigen::Vector2d place(pole.x, pole.y);
      const double range = (place - sensor).norm();
      inRange += range <= kRange;
      hidden += range <= kRange && SightLines::blocked(blocks, sensor, place);
      if (range >= 20) continue;
      poles[i].push_back(detected(i, pole.x, pole.y));
      poles[i].back().radius = pole.radius + 0.01;
      ++found;
    }
  }
  EXPECT_GT(hidden, 0u);
  const auto seen = sightings();
  ASSERT_EQ(seen.size(), 1u) << "neither clutter nor passing detections";
  for (const Sighting& sighting : seen.at(DetectionClass::lampPost)) {
    EXPECT_EQ(sighting.reported.has_value(), sighting.range < 20);
    --inRange;
    hidden -= sighting.hidden;
    if (!sighting.reported) continue;
    --found;
    const std::array<double, kReported>& r = *sighting.reported;
    EXPECT_NEAR(r[0], 0.05, 1e-9);
    EXPECT_NEAR(r[1], 0.05, 1e-9);
    EXPECT_NEAR(r[2], 0.6, 1e-9);
    EXPECT_NEAR(r[3], 0.8, 1e-9);
    EXPECT_NEAR(r[4], 0.75, 1e-6);
    EXPECT_NEAR(r[5], 0.01, 1e-6);
  }
  EXPECT_EQ(found, 0u);
  EXPECT_EQ(inRange, 0u);
  EXPECT_EQ(hidden, 0u);
}

TEST_F(Sightings, ThreeFalseDetectionsAtAPlaceAreClutterOthersPass) {
  // Places on the road, far from all poles.
  const auto road = [&](std::size_t scan) -> Eigen::Vector2d {
    return drive.drive().T_map_sensor[scan].translation().head<2>();
  };
  const Eigen::Vector2d often = road(20), once = road(45), again = road(55);
  for (const std::size_t i : {2, 3, 7}) poles[i].push_back(detected(i, often.x(), often.y()));
  poles[3].push_back(detected(3, once.x(), once.y()));
  poles[40].push_back(detected(40, again.x(), again.y()));
  const auto seen = sightings();
  const auto& clutter = seen.at(DetectionClass::clutter);
  ASSERT_EQ(clutter.size(), 60u) << "in range of all scans";
  for (std::size_t i = 0; i < clutter.size(); ++i) {
    EXPECT_EQ(clutter[i].scan, i);
    EXPECT_EQ(clutter[i].object, 0u);
    EXPECT_NEAR((clutter[i].place - often).norm(), 0.05, 1e-2);
    EXPECT_NEAR(clutter[i].range, (clutter[i].place - road(i)).norm(), 1e-9);
    EXPECT_EQ(clutter[i].reported.has_value(), i == 2 || i == 3 || i == 7);
  }
  const auto& passing = seen.at(DetectionClass::passing);
  ASSERT_EQ(passing.size(), 2u);
  EXPECT_EQ(passing[0].scan, 3u);
  EXPECT_NEAR((passing[0].place - once).norm(), 0.05, 1e-2);
  EXPECT_NEAR(passing[0].range, (passing[0].place - road(3)).norm(), 1e-2);
  EXPECT_EQ(passing[1].scan, 40u);
  EXPECT_EQ((*passing[1].reported)[2], 0) << "it has no true place";
  for (const Sighting& sighting : seen.at(DetectionClass::lampPost))
    EXPECT_FALSE(sighting.reported);
}

}  // namespace
}  // namespace polemcl::test_sightings
