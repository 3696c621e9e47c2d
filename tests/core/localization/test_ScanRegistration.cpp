#include <gtest/gtest.h>

#include "core/localization/ScanRegistration.h"
#include "sim/common/Random.h"
#include "support/Poles.h"

namespace polemcl::test_scan_registration {
namespace {

using namespace polemcl::tests;

using Poles = std::vector<PoleDetection>;

PoleDetection pole(double x, double y, double sigma = 0.03) {
  return detectionAt(x, y, sigma * sigma);
}

/// The same poles from a robot that has moved on.
Poles after(const Poles& before, const Pose2D& motion, sim::Random* random = nullptr) {
  Poles result;
  for (const PoleDetection& p : before) {
    const Pose2D seen = relative(motion, {p.x, p.y, 0});
    const double noise = random ? 0.03 : 0;
    result.push_back(pole(seen.x + (random ? random->normal(0, noise) : 0),
                          seen.y + (random ? random->normal(0, noise) : 0)));
  }
  return result;
}

const Poles kStreet = {pole(5, 6), pole(14, -7), pole(-9, 8), pole(22, 5), pole(-3, -6)};

void expectNear(const Pose2D& a, const Pose2D& b, double metres, double radians) {
  EXPECT_NEAR(a.x, b.x, metres);
  EXPECT_NEAR(a.y, b.y, metres);
  EXPECT_NEAR(wrapAngle(a.yaw - b.yaw), 0, radians);
}

TEST(ScanRegistration, FindsTheExactMotionFromNearAndFromAfar) {
  const Pose2D motion{1.3, -0.2, 0.1};
  const Poles moved = after(kStreet, motion);
  const ScanRegistration near = refineMotion(kStreet, moved, {1.0, 0.0, 0.08}, {});
  expectNear(near.motion, motion, 1e-6, 1e-7);
  EXPECT_EQ(near.pairs, 5);
  EXPECT_NEAR(near.score, 5, 1e-6);
  RegistrationOptions wide;
  wide.maxMetres = 10;
  expectNear(searchMotion(kStreet, after(kStreet, {7, 1, -0.3}), {}, wide).motion, {7, 1, -0.3},
             1e-6, 1e-7);
}

TEST(ScanRegistration, SearchesNoFartherThanTold) {
  RegistrationOptions options;
  options.maxMetres = 3;
  EXPECT_LT(searchMotion(kStreet, after(kStreet, {7, 1, 0}), {}, options).pairs, 3);
  EXPECT_EQ(searchMotion(kStreet, after(kStreet, {7, 1, 0}), {6, 0, 0}, options).pairs, 5);
  EXPECT_EQ(searchMotion(kStreet, after(kStreet, {1, 7, 0}), {0, 6, 0}, options).pairs, 5);
  options.maxRadians = 0.1;
  EXPECT_LT(searchMotion(kStreet, after(kStreet, {1, 0, 0.3}), {}, options).pairs, 3);
}

TEST(ScanRegistration, OutliersAndMissedPolesDoNotMoveIt) {
  const Pose2D motion{0.9, 0.05, -0.02};
  Poles moved = after(kStreet, motion);
  moved.erase(moved.begin());
  moved.insert(moved.begin(), {pole(3, 3), pole(-4, 12), pole(21, -9)});
  const ScanRegistration found = refineMotion(kStreet, moved, {0.5, 0, 0}, {});
  expectNear(found.motion, motion, 1e-6, 1e-7);
  EXPECT_EQ(found.pairs, 4);
}

TEST(ScanRegistration, CovarianceIsThatOfTheErrors) {
  sim::Random random(5);
  const Pose2D motion{1, 0, 0.05};
  RegistrationOptions options;
  options.sigma = 1e-6;
  options.gate = 10;  // so that the tails are not cut off
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero(), stated = Eigen::Matrix3d::Zero();
  const int trials = 2000;
  for (int i = 0; i < trials; ++i) {
    Poles noisy = after(kStreet, {0, 0, 0}, &random);
    const ScanRegistration found =
        refineMotion(noisy, after(kStreet, motion, &random), motion, options);
    ASSERT_EQ(found.pairs, 5);
    const Eigen::Vector3d error(found.motion.x - motion.x, found.motion.y - motion.y,
                                wrapAngle(found.motion.yaw - motion.yaw));
    spread += error * error.transpose() / trials;
    stated += found.covariance / trials;
  }
  for (int k = 0; k < 3; ++k) {
    // Scaled up where residuals are large, never down: a factor of about 1.2.
    EXPECT_GT(stated(k, k), 0.95 * spread(k, k)) << k;
    EXPECT_LT(stated(k, k), 1.5 * spread(k, k)) << k;
  }
}

TEST(ScanRegistration, DetectionsWorseThanTheySayWidenTheCovariance) {
  Poles wrong = after(kStreet, {1, 0, 0});
  for (std::size_t i = 0; i < wrong.size(); ++i)
    wrong[i].x += i % 2 ? 0.14 : -0.14;  // they say 0.03
  RegistrationOptions options;
  options.gate = 10;
  const ScanRegistration exact =
      refineMotion(kStreet, after(kStreet, {1, 0, 0}), {1, 0, 0}, options);
  const ScanRegistration found = refineMotion(kStreet, wrong, {1, 0, 0}, options);
  ASSERT_EQ(found.pairs, 5);
  EXPECT_GT(found.covariance(0, 0), 2 * exact.covariance(0, 0));
}

TEST(ScanRegistration, NothingInCommonGivesNoPairs) {
  const ScanRegistration none = refineMotion(kStreet, {}, {1, 2, 0.3}, {});
  EXPECT_EQ(none.pairs, 0);
  EXPECT_DOUBLE_EQ(none.motion.x, 1);
  EXPECT_EQ(searchMotion({}, kStreet, {}, {}).pairs, 0);
  EXPECT_EQ(judgeMotion(kStreet, kStreet, {5, 0, 0}, {}).pairs, 0);
  EXPECT_EQ(judgeMotion(kStreet, kStreet, {}, {}).pairs, 5);
}

TEST(ScanRegistration, ARowThatMayBeShiftedIsNoticed) {
  Poles row;
  for (int i = -4; i < 5; ++i) row.push_back(pole(4 * i, -6));
  const auto isShifted = [](const Poles& before, double metres, double other) {
    ScanRegistration found;
    found.motion.x = metres;
    found.pairs = static_cast<int>(before.size());
    return isShiftedRow(before, after(before, found.motion), found, {other, 0, 0});
  };
  for (const double other : {-2.0, 6.0, 10.0}) EXPECT_TRUE(isShifted(row, 2, other)) << other;
  for (const double other : {0.0, 1.9, 4.0}) EXPECT_FALSE(isShifted(row, 2, other)) << other;
  for (const double other : {-2.0, 0.0, 6.0}) EXPECT_FALSE(isShifted(kStreet, 2, other)) << other;
}

}  // namespace
}  // namespace polemcl::test_scan_registration
