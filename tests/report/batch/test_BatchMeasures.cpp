#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <polemcl/core/common/Types.h>
#include "report/batch/BatchMeasures.h"
#include "support/SampleBatches.h"

namespace polemcl::report::test_batch_measures {
namespace {
/// A drive along y, 1 m/s; the estimates are off by (dx, dy) in turn.
struct NorthDrive {
  std::vector<StampedPose2D> truth, estimate;
  NorthDrive() {
    const double dx[] = {0.3, -0.1, 0.3, -0.1}, dy[] = {0, 0.4, 0, 0.4};
    const double turn[] = {0.01, 0.03, 0.01, 0.03};
    for (int i = 0; i < 4; ++i) {
      truth.push_back({double(i), {5, double(i), M_PI / 2}});
      estimate.push_back({double(i), {5 + dx[i], i + dy[i], M_PI / 2 + turn[i]}});
    }
  }
  TrajectoryErrors errors() const { return evaluateTrajectory(truth, estimate, Sampling::perPose); }
};

double farthestFrom(const std::vector<Eigen::Vector2d>& line, const Eigen::Vector2d& point) {
  double nearest = HUGE_VAL;
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    for (int k = 0; k <= 1000; ++k)
      nearest = std::min(nearest, (line[i] + k / 1000.0 * (line[i + 1] - line[i]) - point).norm());
  return nearest;
}

TEST(BatchMeasures, FiguresOfADriveNorth) {
  const NorthDrive drive;
  const ErrorMetrics figures = errorMetrics(drive.errors(), drive.truth);
  EXPECT_EQ(figures.poses, 4u);
  EXPECT_NEAR(figures.posEnd, std::hypot(0.1, 0.4), 1e-9);
  // Mean squares: x (0.09 + 0.01) / 2, y 0.16 / 2. Driving north, x is lateral (to the right).
  EXPECT_NEAR(figures.xRmse, std::sqrt(0.05), 1e-9);
  EXPECT_NEAR(figures.yRmse, std::sqrt(0.08), 1e-9);
  EXPECT_NEAR(figures.posRmse, std::sqrt(0.13), 1e-9);
  EXPECT_NEAR(figures.latStd, 0.2, 1e-9);   // +-0.2 about the mean of 0.1
  EXPECT_NEAR(figures.latMean, 0.2, 1e-9);  // of absolute values
  EXPECT_NEAR(figures.lonStd, 0.2, 1e-9);
  EXPECT_NEAR(figures.angMeanDeg, 0.02 * 180 / M_PI, 1e-9);
  EXPECT_NEAR(figures.angStdDeg, 0.01 * 180 / M_PI, 1e-9);
}

TEST(BatchMeasures, AxesAreThoseOfTheMapWhateverTheHeading) {
  NorthDrive drive;
  for (auto* path : {&drive.truth, &drive.estimate})
    for (StampedPose2D& pose : *path) pose.pose.yaw -= 1.1;
  const ErrorMetrics figures = errorMetrics(drive.errors(), drive.truth);
  EXPECT_NEAR(figures.xRmse, std::sqrt(0.05), 1e-9);
  EXPECT_NEAR(figures.yRmse, std::sqrt(0.08), 1e-9);
}

TEST(BatchMeasures, ARunThatNeverKnewItsPoseHasNoFigures) {
  const ErrorMetrics figures = errorMetrics(TrajectoryErrors(), NorthDrive().truth);
  EXPECT_EQ(figures.poses, 0u);
  EXPECT_TRUE(std::isnan(figures.posMean) && std::isnan(figures.angRmseDeg));
}

TEST(BatchMeasures, RefusesTheTruthOfAnotherDrive) {
  const NorthDrive drive;
  std::vector<StampedPose2D> other = drive.truth;
  for (StampedPose2D& pose : other) pose.time += 100;
  EXPECT_THROW(errorMetrics(drive.errors(), other), Error);
}

TEST(BatchMeasures, ErrorsAreCountedInMetresAndDegrees) {
  SessionPlots plots;
  addErrors(plots, NorthDrive().errors());
  addErrors(plots, NorthDrive().errors());
  ErrorHistogram position, heading;
  for (double value : {0.3, std::hypot(0.1, 0.4)}) position.add(value);
  for (double value : {0.01, 0.03}) heading.add(value * 180 / M_PI);
  for (std::size_t i = 0; i < ErrorHistogram::bins; ++i) {
    EXPECT_EQ(plots.positionErrors.counts[i], 4 * position.counts[i]);
    EXPECT_EQ(plots.headingErrors.counts[i], 4 * heading.counts[i]);
  }
}

TEST(BatchMeasures, AStraightPathIsTwoPoints) {
  std::vector<Eigen::Vector2d> path;
  for (int i = 0; i <= 100; ++i) path.emplace_back(0.1 * i, 0.2 * i);
  EXPECT_EQ(thinPath(path, 0.01), (std::vector<Eigen::Vector2d>{{0, 0}, {10, 20}}));
  EXPECT_TRUE(thinPath(std::vector<Eigen::Vector2d>{}).empty());
  EXPECT_EQ(thinPath(std::vector<Eigen::Vector2d>{{1.234, -0.001}}),
            (std::vector<Eigen::Vector2d>{{1.23, 0}}));
}

TEST(BatchMeasures, AThinnedPathStaysWithinTheTolerance) {
  std::vector<Eigen::Vector2d> path;
  for (int i = 0; i < 2000; ++i)
    path.emplace_back(100 * std::cos(0.01 * i), 60 * std::sin(0.0237 * i));
  const double tolerance = 0.5;
  const auto thinned = thinPath(path, tolerance);
  EXPECT_LT(thinned.size(), path.size() / 5);
  for (std::size_t i = 0; i < path.size(); i += 7)
    EXPECT_LE(farthestFrom(thinned, path[i]), tolerance + 0.01) << i;
}

TEST(BatchMeasures, ALoopThatReturnsToItsStartIsKept) {
  const auto thinned =
      thinPath(std::vector<Eigen::Vector2d>{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}});
  EXPECT_EQ(thinned.size(), 5u);
}

TEST(BatchMeasures, BinsKeepTheirLargestError) {
  std::vector<StampedPose2D> truth;
  TrajectoryErrors errors;
  for (int i = 0; i <= 100; ++i) {
    truth.push_back({double(i), {double(i), 0, 0}});
    PoseError error;
    error.time = i;
    error.position = i == 37 ? 0.9 : 0.1 + 0.001 * i;
    if (i < 40 || i >= 60) errors.errors.push_back(error);
  }
  const BinnedMaxima bins = positionOverDistance(errors, truth, 11);
  EXPECT_EQ(bins.binWidth, 10);
  ASSERT_EQ(bins.largest.size(), 11u);
  EXPECT_DOUBLE_EQ(bins.largest[0], 0.109);
  EXPECT_DOUBLE_EQ(bins.largest[3], 0.9);
  EXPECT_TRUE(std::isnan(bins.largest[4]) && std::isnan(bins.largest[5]));
  EXPECT_DOUBLE_EQ(bins.largest[10], 0.2);
}

TEST(BatchMeasures, ScansFartherApartThanAMetreLeaveNoGaps) {
  for (double spacing : {0.4, 1.0, 1.37, 4.9}) {
    std::vector<StampedPose2D> truth;
    TrajectoryErrors errors;
    for (int i = 0; i < 200; ++i) {
      truth.push_back({double(i), {i * spacing, 0, 0}});
      PoseError error;
      error.time = i;
      if (i < 80 || i > 120) errors.errors.push_back(error);
    }
    const std::vector<double> largest = positionOverDistance(errors, truth, 500).largest;
    int gaps = 0;
    for (std::size_t i = 1; i < largest.size(); ++i)
      gaps += std::isnan(largest[i]) && !std::isnan(largest[i - 1]);
    EXPECT_EQ(gaps, 1) << spacing;  // only the one where the pose was not known
  }
}

TEST(BatchMeasures, NeverMoreBinsThanAllowed) {
  for (int length : {1, 7, 99, 100, 499, 500, 1234, 20000}) {
    TrajectoryErrors errors;
    std::vector<StampedPose2D> truth{{0, {0, 0, 0}}, {double(length), {double(length), 0, 0}}};
    for (int i = 0; i <= length; ++i) {
      PoseError error;
      error.time = i;
      errors.errors.push_back(error);
    }
    for (std::size_t most : {2, 10, 500})
      EXPECT_LE(positionOverDistance(errors, truth, most).largest.size(), most) << length;
  }
}

}  // namespace
}  // namespace polemcl::report::test_batch_measures
