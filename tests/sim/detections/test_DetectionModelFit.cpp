#include <gtest/gtest.h>

#include <memory>

#include "sim/detections/DetectionModelFit.h"
#include "sim/detections/DetectionSampler.h"
#include "sim/detections/DetectionSummary.h"
#include "support/DetectionModels.h"
#include "support/Refusal.h"

namespace polemcl::test_detection_model_fit {

using namespace polemcl::sim;

namespace {
/// Drives whose detections are sampled from a model: the fit must return that model.
struct Drawn {
  std::vector<std::unique_ptr<SimulatedDrive>> drives;
  std::vector<ObservedDrive> observed;

  void add(const DetectionModel& model, std::uint64_t seed, int day, double length = 60,
           double spacing = SimulationOptions().spacing, double height = 1) {
    SimulationOptions options;
    options.spacing = spacing;
    options.height = height;
    options.world.length = length;
    options.world.seed = seed;
    options.world.day = day;
    options.world.removedShare = 0;
    drives.push_back(std::make_unique<SimulatedDrive>(options));
    const SimulatedDrive& drive = *drives.back();
    const DetectionSampler sampler(model, drive.world(), options);
    observed.push_back({&drive, {}, {}});
    for (std::size_t i = 0; i < drive.scans(); ++i) {
      observed.back().poles.push_back(sampler.sample(i, drive.drive().T_map_sensor[i]));
      observed.back().points.push_back(5000);
    }
  }
  DetectionModel fit() const {
    return fitDetectionModel({{observed[0], observed[1]}}, 40, "drawn");
  }
};

double sum(const std::array<double, 5>& shares) {
  double total = 0;
  for (const double share : shares) total += share;
  return total;
}
}  // namespace

TEST(DetectionModelFit, FindsTheModelThatTheDetectionsAreDrawnFrom) {
  DetectionModel truth = testing_sim::plainModel();
  for (int c = 0; c < static_cast<int>(DetectionClass::clutter); ++c)
    truth.classes[c].detected = {0.8, 0.4};
  truth.poleVisibility.always = {0, 0, 0.3, 0, 0.2};
  truth.poleVisibility.today = {0, 0.2, 0, 0, 0};
  truth.noise[static_cast<int>(Reported::errorAlong)].always[4] = 0.5;
  truth.clutterAlways = 0.03;
  truth.clutterToday = 0.02;
  truth.passing = 0.2;
  Drawn drawn;
  drawn.add(truth, 11, 0, 1200);
  drawn.add(truth, 11, 1, 1200);
  const DetectionModel fitted = drawn.fit();

  EXPECT_EQ(fitted.sensor, "hdl32e");
  EXPECT_EQ(fitted.points, 5000u);
  EXPECT_EQ(fitted.fittedOn, "drawn");
  for (const double range : {7.0, 20.0, 32.0})
    EXPECT_NEAR(fitted.detectionScore(DetectionClass::sign, range),
                truth.detectionScore(DetectionClass::sign, range), 0.25)
        << range;
  EXPECT_NEAR(fitted.behindHouses, 0, 0.01);
  EXPECT_NEAR(fitted.value(DetectionClass::sign, Reported::sigmaAlong, 15, 0), 0.05, 1e-6);
  EXPECT_NEAR(fitted.value(DetectionClass::tree, Reported::errorAcross, 15, 1), 1, 0.15);
  EXPECT_NEAR(fitted.value(DetectionClass::tree, Reported::errorAcross, 15, 0), 0, 0.15);
  EXPECT_NEAR(sum(fitted.poleVisibility.always), 0.5, 0.12);
  EXPECT_NEAR(sum(fitted.poleVisibility.today), 0.2, 0.12);
  EXPECT_NEAR(sum(fitted.noiseOf(Reported::errorAlong).always), 0.5, 0.08);
  EXPECT_NEAR(sum(fitted.noiseOf(Reported::errorAcross).always), 0, 0.05);
  EXPECT_NEAR(fitted.clutterAlways, 0.03, 0.012);
  EXPECT_NEAR(fitted.clutterToday, 0.02, 0.012);
  EXPECT_NEAR(fitted.passing, 0.2, 0.04);
  EXPECT_NEAR(valueAt(fitted.clutterLateral, 0), 8, 0.5);
  EXPECT_NEAR(valueAt(fitted.passingRange, 0), 15, 0.3);
}

TEST(DetectionModelFit, WantsOneStreetOnTwoDays) {
  const DetectionModel model = testing_sim::plainModel();
  Drawn oneDay, twoStreets;
  oneDay.add(model, 3, 0);
  oneDay.add(model, 3, 0);
  EXPECT_THROW(oneDay.fit(), Error);
  twoStreets.add(model, 3, 0);
  twoStreets.add(model, 4, 1);
  EXPECT_THROW(twoStreets.fit(), Error);
  EXPECT_THROW(fitDetectionModel({}, 40, ""), Error);
}

TEST(DetectionModelFit, WantsOneLidarAtOneHeightAndSpacing) {
  const DetectionModel model = testing_sim::plainModel();
  const auto fitted = [&](double spacing, double height, double range) {
    Drawn drawn;
    for (const int day : {0, 1}) drawn.add(model, 3, day);
    DetectionModel other = model;
    other.height = height;
    for (const int day : {0, 1}) drawn.add(other, 4, day, 60, spacing, height);
    const auto& seen = drawn.observed;
    return fitDetectionModel({{seen[0], seen[1]}, {seen[2], seen[3]}}, range, "drawn");
  };
  const double spacing = SimulationOptions().spacing, height = 1;
  EXPECT_REFUSED(fitted(2 * spacing, height, 40), "differ in spacing_m");
  EXPECT_REFUSED(fitted(spacing, 2 * height, 40), "differ in [sensor] height_m");
  EXPECT_REFUSED(fitted(spacing, height, 1.5), "max_range_m");
}

TEST(DetectionModelFit, RefusesDrivesWithoutPoles) {
  DetectionModel model = testing_sim::plainModel();
  for (auto& own : model.classes)
    if (!own.detected.empty()) own.detected = {0, 0};
  Drawn drawn;
  drawn.add(model, 3, 0);
  drawn.add(model, 3, 1);
  EXPECT_THROW(drawn.fit(), Error);
}

TEST(DetectionSummary, CountsWhatWasPutThere) {
  SimulationOptions options;
  options.world.length = 100;
  options.world.relief = 0;
  options.scans = 60;
  const SimulatedDrive drive(options);
  const SightLines sight(drive.world());
  ObservedDrive observed{&drive, {}, {}};
  // Every visible pole within 20 m, 3 cm too far and 4 cm to the left; missed in scans 30 to 39.
  std::size_t poles = 0;
  for (std::size_t i = 0; i < drive.scans(); ++i) {
    const Eigen::Isometry3d& T = drive.drive().T_map_sensor[i];
    const Eigen::Vector2d sensor = T.translation().head<2>();
    const auto blocks = sight.around(sensor, 40);
    std::vector<PoleDetection> found;
    for (const TruePole& pole : drive.world().poles()) {
      const Eigen::Vector3d place(pole.x, pole.y, T.translation().z());
      if ((place.head<2>() - sensor).norm() >= 20 || (i >= 30 && i < 40) ||
          SightLines::blocked(blocks, sensor, place.head<2>()))
        continue;
      const Eigen::Vector2d p = (T.inverse() * place).head<2>(), ray = p.normalized();
      PoleDetection detection;
      detection.x = p.x() + 0.03 * ray.x() - 0.04 * ray.y();
      detection.y = p.y() + 0.03 * ray.y() + 0.04 * ray.x();
      detection.covariance = Eigen::Matrix2d::Identity() * 0.0025;
      found.push_back(detection);
    }
    poles += found.size();
    PoleDetection wrong;  // high above the road, and elsewhere in each scan
    wrong.x = 60 + static_cast<double>(i);
    found.push_back(wrong);
    observed.poles.push_back(found);
    observed.points.push_back(1);
  }
  const DetectionSummary s = summarizeDetections(observed, 40);
  EXPECT_EQ(s.scans, 60u);
  EXPECT_EQ(s.detections, poles + 60);
  EXPECT_NEAR(s.falsePerScan, 1, 1e-9);
  ASSERT_EQ(s.recall.size(), 8u);
  EXPECT_EQ(s.rangeEdges.back(), 40);
  EXPECT_GT(*s.recall[1], 0.7);
  EXPECT_LT(*s.recall[1], 1.0);
  EXPECT_EQ(*s.recall[5], 0);
  EXPECT_NEAR(*s.centreMedian, 0.05, 1e-3);
  EXPECT_NEAR(*s.neesMean, 1, 0.02);
  EXPECT_NEAR(*s.missedRun, 5, 1e-9) << "ten scans of half a metre";
  EXPECT_THROW(summarizeDetections({&drive, {}, {}}, 40), Error);
}

}  // namespace polemcl::test_detection_model_fit
