#include <gtest/gtest.h>

#include <cmath>

#include "core/evaluation/DetectionEvaluation.h"
#include "support/Poles.h"

namespace polemcl::test_detection_evaluation {
namespace {

using namespace polemcl::tests;

PoleDetection detection(double x, double y, double confidence, double radius = 0.1) {
  PoleDetection d = detectionAt(x, y);
  d.confidence = confidence;
  d.radius = radius;
  return d;
}

TEST(DetectionEvaluation, CountsRightDetectionsAndVisiblePoles) {
  DetectionEvaluation evaluation;
  // Right and visible; right though not visible; a second one on a pole already taken; nothing
  // there. One of three visible poles is found.
  evaluation.add(
      {detection(10, 0.1, 0.9), detection(0, 20, 0.8), detection(10, -0.3, 0.6),
       detection(-5, -5, 0.7)},
      {{10, 0, 0.1, true}, {0, 20.2, 0.1, false}, {30, 0, 0.1, true}, {9, 9, 0.1, true}});
  evaluation.add({}, {{1, 1, 0.1, true}});
  const DetectionScore score = evaluation.score();
  EXPECT_EQ(score.scans, 2u);
  EXPECT_EQ(score.detections, 4u);
  EXPECT_EQ(score.right, 2u);
  EXPECT_EQ(score.visible, 4u);
  EXPECT_EQ(score.found, 1u);
  EXPECT_DOUBLE_EQ(*score.precision, 0.5);
  EXPECT_DOUBLE_EQ(*score.recall, 0.25);
  // Both right ones are more confident than both wrong ones.
  EXPECT_DOUBLE_EQ(*score.auc, 1.0);
}

TEST(DetectionEvaluation, ErrorsAreThoseOfTheHand) {
  DetectionEvaluation evaluation;
  // Seen from the origin: 3 cm beyond and 4 cm left of a pole on the y axis; then 10 cm short of
  // one on the x axis, with another covariance.
  PoleDetection second = detection(9.9, 0, 0.9, 0.07);
  second.covariance << 0.005, 0, 0, 1;
  evaluation.add({detection(-0.04, 10.03, 0.9, 0.12), second},
                 {{0, 10, 0.1, true}, {10, 0, 0.1, true}});
  const DetectionScore score = evaluation.score();
  EXPECT_NEAR(*score.centreMean, 0.075, 1e-12);
  EXPECT_NEAR(*score.centreMedian, 0.075, 1e-12);
  EXPECT_NEAR(*score.centre90, 0.095, 1e-12);
  EXPECT_NEAR(*score.biasAlong, (0.03 - 0.1) / 2, 1e-12);
  EXPECT_NEAR(*score.biasAcross, 0.02, 1e-12);
  EXPECT_NEAR(*score.radiusMean, (0.02 - 0.03) / 2, 1e-12);
  EXPECT_NEAR(*score.radiusMedian, 0.025, 1e-12);
  EXPECT_NEAR(*score.neesMean, (0.25 + 2.0) / 2, 1e-9);
  EXPECT_NEAR(*score.neesMedian, (0.25 + 2.0) / 2, 1e-9);
}

TEST(DetectionEvaluation, CorrelatedErrorsAreWeighedByTheWholeCovariance) {
  DetectionEvaluation evaluation;
  PoleDetection d = detection(10.1, 0.1, 0.9);
  d.covariance << 0.02, 0.01, 0.01, 0.02;  // inverse: 1/0.0003 · [0.02 -0.01; -0.01 0.02]
  evaluation.add({d}, {{10, 0, 0.1, true}});
  EXPECT_NEAR(*evaluation.score().neesMean, 2 * (0.01 * 0.02 - 0.01 * 0.01) / 0.0003, 1e-9);
}

TEST(DetectionEvaluation, AreaUnderTheRocCountsPairs) {
  DetectionEvaluation evaluation;
  // Right: 0.9 and 0.6; wrong: 0.6, 0.7 and 0.5. Four of six pairs are in order, one is a tie.
  evaluation.add({detection(1, 0, 0.9), detection(0, 1, 0.6), detection(50, 0, 0.6),
                  detection(60, 0, 0.7), detection(70, 0, 0.5)},
                 {{1, 0, 0.1, true}, {0, 1, 0.1, true}});
  EXPECT_NEAR(*evaluation.score().auc, 4.5 / 6, 1e-12);
}

TEST(DetectionEvaluation, NothingToComputeFromIsNone) {
  DetectionEvaluation evaluation;
  evaluation.add({}, {});
  const DetectionScore score = evaluation.score();
  EXPECT_FALSE(score.precision || score.recall || score.centreMean || score.centreMedian ||
               score.neesMean || score.auc || score.biasAlong || score.radiusMean);
  evaluation.add({detection(1, 0, 0.9)}, {{1, 0, 0.1, true}});
  EXPECT_FALSE(evaluation.score().auc);
  EXPECT_TRUE(evaluation.score().precision);
}

TEST(DetectionEvaluation, RefusesWhatMakesNoSense) {
  EXPECT_THROW(DetectionEvaluation(0), Error);
  DetectionEvaluation evaluation;
  EXPECT_THROW(evaluation.add({detection(NAN, 0, 0.9)}, {}), Error);
  PoleDetection flat = detection(1, 0, 0.9);
  flat.covariance << 0.01, 0.01, 0.01, 0.01;
  flat.covariance(1, 1) = -0.01;
  EXPECT_THROW(evaluation.add({flat}, {{1, 0, 0.1, true}}), Error);
}

struct Cloud {
  std::vector<float> x, y, z;
  std::vector<std::uint32_t> labels;
  void add(double px, double py, double pz, std::uint32_t label) {
    x.push_back(static_cast<float>(px));
    y.push_back(static_cast<float>(py));
    z.push_back(static_cast<float>(pz));
    labels.push_back(label);
  }
  /// `count` points above one another, from `low` to `high`.
  void column(double px, double py, int count, double low, double high, std::uint32_t label) {
    for (int i = 0; i < count; ++i) add(px, py, low + (high - low) * i / (count - 1), label);
  }
  PointsView view() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

const Eigen::Isometry3d kHere = Eigen::Isometry3d::Identity();
constexpr std::uint32_t kFoliage = 0x80000000u;

TEST(PoleVisibility, SixReturnsOverSixtyCentimetresWithinFortyMetres) {
  Cloud cloud;
  cloud.column(10, 0, 6, 0.0, 0.625, 1);   // just enough
  cloud.column(10, 5, 5, 0.0, 2.0, 2);     // too few
  cloud.column(10, 10, 20, 0.0, 0.59, 3);  // too low
  cloud.column(40.5, 0, 9, 0.0, 2.0, 4);   // too far
  cloud.column(39.5, 3, 9, 0.0, 2.0, 5);
  const std::vector<WorldPole> poles{{1, 10, 0},   {2, 10, 5},   {3, 10, 10},
                                     {4, 40.5, 0}, {5, 39.5, 3}, {6, 5, 5}};
  const auto sights = sightPoles(cloud.view(), cloud.labels, kHere, poles);
  const std::vector<bool> expected{true, false, false, false, true, false};
  for (std::size_t i = 0; i < poles.size(); ++i) EXPECT_EQ(sights[i].visible, expected[i]) << i;
  EXPECT_EQ(sights[2].returns, 20u);
  EXPECT_EQ(sights[5].returns, 0u);
}

TEST(PoleVisibility, FoliageAndOtherThingsDoNotCount) {
  Cloud cloud;
  cloud.column(10, 0, 5, 0.0, 2.0, 7);
  cloud.column(10, 0, 30, 2.0, 5.0, 7 | kFoliage);
  cloud.column(10, 0, 30, 0.0, 2.0, 0);
  const auto sights = sightPoles(cloud.view(), cloud.labels, kHere, {{7, 10, 0}});
  EXPECT_EQ(sights[0].returns, 5u);
  EXPECT_FALSE(sights[0].visible);
}

TEST(PoleVisibility, HeightsAndRangesAreThoseOfTheMap) {
  // The sensor hangs upside down, 3 m up at (100, 50): up in the map is down in the cloud.
  Eigen::Isometry3d pose(Eigen::Translation3d(100, 50, 3));
  pose.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  Cloud cloud;
  for (const double z : {-1.0, 0.0, 0.2, 0.4, 1.0, 2.5}) cloud.add(5, 0, z, 1);
  const auto sights = sightPoles(cloud.view(), cloud.labels, pose, {{1, 105, 50}, {2, 100, 54}});
  EXPECT_NEAR(sights[0].lowest, 0.5, 1e-6);
  EXPECT_NEAR(sights[0].highest, 4.0, 1e-6);
  EXPECT_DOUBLE_EQ(sights[0].sensor, 3);
  EXPECT_NEAR(sights[0].range, 5, 1e-12);
  EXPECT_DOUBLE_EQ(sights[1].lowest, 3);
  EXPECT_NEAR(sights[1].range, 4, 1e-12);
}

TEST(PoleVisibility, APoleIsTakenAtTheHeightOfALeaningSensor) {
  // Nose down by 0.05: the place level with the sensor, 20 m ahead, hardly comes nearer.
  Eigen::Isometry3d pose(Eigen::Translation3d(1, 2, 10));
  pose.rotate(Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY()));
  PoleSight sight;
  sight.sensor = 10;
  sight.visible = true;
  const auto poles = polesInScan({{1, 21, 2, 0.2}}, {sight}, pose.inverse());
  ASSERT_EQ(poles.size(), 1u);
  EXPECT_NEAR(poles[0].x, 20 * std::cos(0.05), 1e-12);
  EXPECT_NEAR(poles[0].y, 0, 1e-12);
  EXPECT_DOUBLE_EQ(poles[0].radius, 0.2);
  EXPECT_TRUE(poles[0].visible);
}

TEST(PoleVisibility, RefusesWhatDoesNotBelongTogether) {
  Cloud cloud;
  cloud.add(1, 0, 0, 1);
  EXPECT_THROW(sightPoles(cloud.view(), {}, kHere, {}), Error);
  EXPECT_THROW(sightPoles(cloud.view(), cloud.labels, kHere, {{1, 0, 0}, {1, 2, 0}}), Error);
}

}  // namespace

}  // namespace polemcl::test_detection_evaluation
