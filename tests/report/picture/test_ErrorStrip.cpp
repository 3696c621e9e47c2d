#include <gtest/gtest.h>

#include "report/picture/ErrorStrip.h"

namespace polemcl::report::test_error_strip {
namespace {

PoseError errorAt(double time) {
  PoseError error;
  error.time = time;
  return error;
}

}  // namespace

TEST(ErrorStrip, DistanceFollowsTheTruePathRoundACorner) {
  const std::vector<StampedPose2D> truth = {{0, {0, 0, 0}}, {1, {3, 0, 0}}, {3, {3, 4, 0}}};
  const std::vector<double> along = distanceDriven(
      truth,
      {errorAt(-1), errorAt(0), errorAt(0.5), errorAt(1), errorAt(2), errorAt(3), errorAt(9)});
  EXPECT_EQ(along, (std::vector<double>{0, 0, 1.5, 3, 5, 7, 7}));
}

TEST(ErrorStrip, AxisEndsJustAboveTheLargestValue) {
  EXPECT_NEAR(valueLimit({1, 2, 3, 2, 1}), 3.3, 1e-12);
}

TEST(ErrorStrip, AShortSearchDoesNotFlattenTheRest) {
  std::vector<double> values(100, 0.05);
  values[0] = 2.5;
  EXPECT_NEAR(valueLimit(values), 2.2 * 0.05, 1e-12);
}

TEST(ErrorStrip, FlawlessSeriesStillHasAnAxis) {
  EXPECT_GT(valueLimit({0, 0, 0}), 0);
}

}  // namespace polemcl::report::test_error_strip
