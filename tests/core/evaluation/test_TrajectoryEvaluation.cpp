#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/evaluation/TrajectoryEvaluation.h"

namespace polemcl::test_trajectory_evaluation {
namespace {

/// 1 m/s along x, a sample a second, from 0 to `last` seconds.
std::vector<StampedPose2D> straightTruth(int last) {
  std::vector<StampedPose2D> truth;
  for (int t = 0; t <= last; ++t) truth.push_back({double(t), {double(t), 0, 0}});
  return truth;
}

constexpr double kDegree = M_PI / 180;

TEST(Evaluation, ErrorsByHand) {
  // At 1 s 0.3 m ahead, 0.4 m to the left, 2° to the left; at 2 s 0.5 m behind, 4° to the right.
  const auto e = evaluateTrajectory(straightTruth(3),
                                    {{1, {1.3, 0.4, 2 * kDegree}}, {2, {1.5, 0, -4 * kDegree}}},
                                    Sampling::perPose);
  ASSERT_EQ(e.errors.size(), 2u);
  EXPECT_NEAR(e.errors[0].longitudinal, 0.3, 1e-12);
  EXPECT_NEAR(e.errors[0].lateral, 0.4, 1e-12);
  EXPECT_NEAR(e.errors[0].position, 0.5, 1e-12);
  EXPECT_NEAR(e.errors[0].heading, 2 * kDegree, 1e-12);
  EXPECT_NEAR(e.errors[1].longitudinal, -0.5, 1e-12);
  EXPECT_NEAR(e.errors[1].heading, -4 * kDegree, 1e-12);
  EXPECT_EQ(e.errors[1].time, 2);
  EXPECT_EQ(e.poses, 2u);
  EXPECT_EQ(e.unmatched, 0u);
  EXPECT_NEAR(e.posMean, 0.5, 1e-12);
  EXPECT_NEAR(e.posRmse, 0.5, 1e-12);
  EXPECT_NEAR(e.posMax, 0.5, 1e-12);
  EXPECT_NEAR(e.latMean, 0.2, 1e-12);
  EXPECT_NEAR(e.lonMean, 0.4, 1e-12);
  EXPECT_NEAR(e.angMeanDeg, 3, 1e-9);
  EXPECT_NEAR(e.angRmseDeg, std::sqrt(10.0), 1e-9);
}

TEST(Evaluation, LateralAndLongitudinalTurnWithTheTruth) {
  // Looking to -y: ahead is -y, left is +x.
  const std::vector<StampedPose2D> truth{{0, {5, 5, -M_PI / 2}}};
  const auto e = evaluateTrajectory(truth, {{0, {5.1, 4.8, M_PI / 2 + 0.1}}}, Sampling::perPose);
  EXPECT_NEAR(e.errors[0].longitudinal, 0.2, 1e-12);
  EXPECT_NEAR(e.errors[0].lateral, 0.1, 1e-12);
  EXPECT_NEAR(e.errors[0].heading, -M_PI + 0.1, 1e-12);
}

TEST(Evaluation, RmseWeighsTheLargeError) {
  const auto e =
      evaluateTrajectory(straightTruth(3), {{1, {1, 3, 0}}, {2, {2, 1, 0}}}, Sampling::perPose);
  EXPECT_NEAR(e.posMean, 2, 1e-12);
  EXPECT_NEAR(e.posRmse, std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(e.posMax, 3, 1e-12);
}

TEST(Evaluation, TruthIsInterpolatedInTimeAcrossTheTurnOfTheCircle) {
  const std::vector<StampedPose2D> truth{{0, {0, 0, M_PI - 0.1}}, {1, {4, 2, -M_PI + 0.3}}};
  const auto e = evaluateTrajectory(truth, {{0.25, {1, 0.5, M_PI}}}, Sampling::perPose);
  EXPECT_NEAR(e.errors[0].position, 0, 1e-12);
  EXPECT_NEAR(e.errors[0].heading, 0, 1e-12);
}

TEST(Evaluation, EstimatesOutsideTheTruthOrInItsGapsAreCounted) {
  std::vector<StampedPose2D> truth = straightTruth(4);
  truth.push_back({14, {14, 0, 0}});  // 10 s without a sample
  truth.push_back({15, {15, 0, 0}});
  std::vector<StampedPose2D> estimate;
  for (double t : {-1.0, 0.0, 1.5, 4.0, 9.0, 14.0, 14.5, 15.5}) estimate.push_back({t, {t, 0, 0}});
  const auto e = evaluateTrajectory(truth, estimate, Sampling::perPose);
  EXPECT_EQ(e.poses, 5u);
  EXPECT_EQ(e.unmatched, 3u);  // -1, 9 and 15.5
  EXPECT_EQ(evaluateTrajectory(truth, estimate, Sampling::perPose, 10.0).unmatched, 2u);
}

TEST(TrajectoryEvaluator, PoseByPoseIsTheSameAsAllAtOnce) {
  auto truth = straightTruth(60);
  truth.erase(truth.begin() + 20, truth.begin() + 25);  // a gap
  std::vector<StampedPose2D> estimate;
  std::mt19937 generator(5);
  for (double t = -3.5; t < 63; t += 0.7) {
    const auto off = [&] { return 1e-3 * (double(generator() % 1000) - 500); };
    estimate.push_back({t, {t + off(), off(), off()}});
  }
  const auto expected = evaluateTrajectory(truth, estimate, Sampling::perPose);
  TrajectoryEvaluator evaluator(truth);
  std::size_t compared = 0;
  for (const auto& pose : estimate)
    if (const auto error = evaluator.add(pose)) {
      EXPECT_EQ(error->time, expected.errors[compared].time);
      EXPECT_EQ(error->lateral, expected.errors[compared].lateral);
      ++compared;
    }
  const auto summary = evaluator.finish();
  EXPECT_EQ(evaluator.estimates(), estimate.size());
  EXPECT_EQ(compared, expected.errors.size());
  EXPECT_EQ(summary.poses, expected.poses);
  EXPECT_EQ(summary.unmatched, expected.unmatched);
  EXPECT_GT(summary.unmatched, 5u);
  EXPECT_TRUE(summary.errors.empty());
  for (const auto figure :
       {&TrajectoryErrors::posMean, &TrajectoryErrors::posRmse, &TrajectoryErrors::posMax,
        &TrajectoryErrors::latMean, &TrajectoryErrors::lonMean, &TrajectoryErrors::angMeanDeg,
        &TrajectoryErrors::angRmseDeg})
    EXPECT_EQ(summary.*figure, expected.*figure);
}

TEST(TrajectoryEvaluator, RefusesWhatEvaluateTrajectoryRefuses) {
  const auto truth = straightTruth(10);
  EXPECT_THROW(TrajectoryEvaluator({}), Error);
  EXPECT_THROW(TrajectoryEvaluator(truth).finish(), Error);
  TrajectoryEvaluator evaluator(truth);
  evaluator.add({1, {}});
  EXPECT_THROW(evaluator.add({1, {}}), Error);
  EXPECT_THROW(evaluator.add({2, {NAN, 0, 0}}), Error);
  evaluator.add({20, {}});
  evaluator.finish();  // one of two
  evaluator.add({21, {}});
  EXPECT_THROW(evaluator.finish(), Error);
}

TEST(Evaluation, PerMetreComparesAtWholeMetresOfTheTruePath) {
  // A corner: 2.5 m along x in 5 s, then 2.5 m along y in 2.5 s.
  const std::vector<StampedPose2D> truth{{0, {0, 0, 0}}, {5, {2.5, 0, 0}}, {7.5, {2.5, 2.5, 0}}};
  // The estimate is off by 0.1·t in y.
  std::vector<StampedPose2D> estimate;
  for (double t : {0.0, 5.0, 7.5}) {
    estimate.push_back({t, {t < 5 ? t / 2 : 2.5, (t < 5 ? 0 : t - 5) + 0.1 * t, 0}});
  }
  const auto e = evaluateTrajectory(truth, estimate, Sampling::perMetre, 10);
  const std::vector<double> times{0, 2, 4, 5.5, 6.5, 7.5};
  ASSERT_EQ(e.errors.size(), times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(e.errors[i].time, times[i], 1e-9);
    EXPECT_NEAR(e.errors[i].position, 0.1 * times[i], 1e-9);
  }
  EXPECT_EQ(e.poses, 6u);
}

TEST(Evaluation, PerMetreDoesNotCountStandingTwice) {
  std::vector<StampedPose2D> truth, estimate;
  for (int t = 0; t <= 100;
       ++t) {  // 1 m/s, but standing from 10 s to 90 s where the estimate is bad
    const double x = t < 10 ? t : t < 90 ? 10 : t - 80;
    truth.push_back({double(t), {x, 0, 0}});
    estimate.push_back({double(t), {x, t > 10 && t < 90 ? 5.0 : 0.0, 0}});
  }
  EXPECT_NEAR(evaluateTrajectory(truth, estimate, Sampling::perMetre).posMean, 0, 1e-12);
  EXPECT_GT(evaluateTrajectory(truth, estimate, Sampling::perPose).posMean, 3);
}

TEST(Evaluation, PerMetreStartsAtTheFirstEstimateAndEndsWithTheLast) {
  const auto e = evaluateTrajectory(
      straightTruth(100), {{10.5, {10.5, 0, 0}}, {11.5, {11.5, 0, 0}}, {12.6, {12.6, 0, 0}}},
      Sampling::perMetre);
  ASSERT_EQ(e.errors.size(), 3u);
  EXPECT_NEAR(e.errors[0].time, 10.5, 1e-12);
  EXPECT_NEAR(e.errors[2].time, 12.5, 1e-12);
}

TEST(Evaluation, PerMetreCountsTheMetresOfAGap) {
  std::vector<StampedPose2D> estimate;
  for (int t : {0, 1, 2, 3, 4, 5, 6, 10, 11, 12})
    estimate.push_back({double(t), {double(t), 0, 0}});
  const auto e = evaluateTrajectory(straightTruth(12), estimate, Sampling::perMetre);
  EXPECT_EQ(e.poses, 10u);
  EXPECT_EQ(e.unmatched, 3u);  // 7, 8, 9
}

TEST(Evaluation, RefusesWhenLessThanHalfCanBeCompared) {
  const auto truth = straightTruth(3);
  const auto at = [](double t) { return StampedPose2D{t, {t, 0, 0}}; };
  EXPECT_EQ(evaluateTrajectory(truth, {at(2), at(3), at(4), at(5)}, Sampling::perPose).poses, 2u);
  for (Sampling sampling : {Sampling::perPose, Sampling::perMetre}) {
    EXPECT_THROW(evaluateTrajectory(truth, {at(3), at(4), at(5)}, sampling), Error);
    EXPECT_THROW(evaluateTrajectory(truth, {at(100)}, sampling), Error);
  }
  // Ten estimates, but the metres lie in the gaps of the estimate.
  EXPECT_THROW(evaluateTrajectory(straightTruth(20), {at(0), at(1), at(20)}, Sampling::perMetre),
               Error);
}

TEST(Evaluation, RefusesTrajectoriesThatAreNone) {
  using Trajectory = std::vector<StampedPose2D>;
  const double nan = std::nan("");
  const Trajectory truth = straightTruth(3), one{{1, {}}}, twice{{1, {}}, {1, {}}},
                   back{{2, {}}, {1, {}}}, wrong{{1, {0, nan, 0}}}, timeless{{nan, {}}};
  for (const auto& [a, b] : {std::pair{Trajectory(), one},
                             {truth, {}},
                             {truth, twice},
                             {back, one},
                             {truth, wrong},
                             {timeless, one}})
    EXPECT_THROW(evaluateTrajectory(a, b, Sampling::perPose), Error) << a.size() << ' ' << b.size();
}

TEST(Evaluation, DistanceFollowsTheTruePathRoundACorner) {
  const std::vector<StampedPose2D> truth{{0, {0, 0, 0}}, {1, {3, 0, 0}}, {3, {3, 4, 0}}};
  std::vector<PoseError> errors;
  for (const double time : {-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 9.0}) errors.push_back({time});
  EXPECT_EQ(distanceDriven(truth, errors), (std::vector<double>{0, 0, 1.5, 3, 5, 7, 7}));
}

}  // namespace
}  // namespace polemcl::test_trajectory_evaluation
