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

}  // namespace
}  // namespace polemcl::test_detection_evaluation
