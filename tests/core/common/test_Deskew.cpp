#include <gtest/gtest.h>

#include <cmath>

#include "core/common/Deskew.h"

namespace polemcl::test_deskew {

TEST(Deskew, VelocityAndMotionAreInverse) {
  for (const Pose2D& motion : {Pose2D{1.2, 0.1, 0.3}, Pose2D{-0.5, 0, 0}, Pose2D{2, -0.4, -1.1}}) {
    const Pose2D again = motionAfter(velocityOf(motion, 0.25), 0.25);
    EXPECT_NEAR(again.x, motion.x, 1e-12);
    EXPECT_NEAR(again.y, motion.y, 1e-12);
    EXPECT_NEAR(again.yaw, motion.yaw, 1e-12);
  }
}

TEST(Deskew, AQuarterCircleIsOne) {
  // 2 m/s and 1 rad/s: a circle of 2 m around a point to the left.
  const Pose2D quarter = motionAfter({2, 0, 1}, M_PI / 2);
  EXPECT_NEAR(quarter.x, 2, 1e-12);
  EXPECT_NEAR(quarter.y, 2, 1e-12);
  EXPECT_NEAR(quarter.yaw, M_PI / 2, 1e-12);
}

/// Poles that stand still, seen from a vehicle on an arc: each is measured from where the vehicle
/// is at its own moment, and must end where it is seen from at the time stamp.
TEST(Deskew, StandingPolesAreSeenFromOnePlace) {
  const Velocity velocity{10, 0.2, 0.4};
  const Pose2D stamped{3, -1, 0.7};
  std::vector<PoleDetection> poles;
  std::vector<Pose2D> expected;
  for (const double offset : {-0.05, -0.01, 0.0, 0.03, 0.05}) {
    const Pose2D place{12 + 100 * offset, 5, 0};
    const Pose2D seen = relative(compose(stamped, motionAfter(velocity, offset)), place);
    PoleDetection pole;
    pole.x = seen.x;
    pole.y = seen.y;
    pole.covariance << 0.04, 0, 0, 0.01;
    pole.timeOffset = offset;
    poles.push_back(pole);
    expected.push_back(relative(stamped, place));
  }
  deskew(poles, velocity);
  for (std::size_t i = 0; i < poles.size(); ++i) {
    EXPECT_NEAR(poles[i].x, expected[i].x, 1e-12);
    EXPECT_NEAR(poles[i].y, expected[i].y, 1e-12);
    EXPECT_EQ(poles[i].timeOffset, 0);
  }
  EXPECT_EQ(poles[2].covariance(0, 1), 0) << "measured at the stamp: unchanged";
  EXPECT_NEAR(poles[4].covariance(0, 1), 0.03 * std::sin(0.02) * std::cos(0.02), 1e-12);
}

/// Azimuth at which a turning beam meets the left (side 1) or right (-1) edge of a pole that stands
/// still, from a vehicle that moves; robot frame.
double edge(const PoleDetection& place, double turnRate, const Velocity& velocity, int side) {
  const double middle = std::atan2(place.y, place.x);
  double azimuth = middle;
  for (int i = 0; i < 50; ++i) {
    const Pose2D seen =
        relative(motionAfter(velocity, (azimuth - middle) / turnRate), {place.x, place.y, 0});
    azimuth =
        std::atan2(seen.y, seen.x) + side * std::asin(place.radius / std::hypot(seen.x, seen.y));
  }
  return azimuth;
}

// At 15 m/s a beam with ten turns a second makes radii 2 to 10 % too great or too small.
TEST(Deskew, ThePoleThatMovesWithTheBeamKeepsItsRadius) {
  const Velocity velocity{15, -0.3, 0.5};
  for (const double turnRate : {-20 * M_PI, 20 * M_PI})
    for (const Pose2D& at :
         {Pose2D{1, 8, 0}, Pose2D{2, -5, 0}, Pose2D{12, -1, 0}, Pose2D{-4, 3, 0}}) {
      PoleDetection place;
      place.x = at.x;
      place.y = at.y;
      place.radius = 0.15;
      PoleDetection seen = place;
      seen.turnRate = turnRate;
      const double distance = std::hypot(at.x, at.y);
      const double width = edge(place, turnRate, velocity, 1) - edge(place, turnRate, velocity, -1);
      seen.radius = distance * std::sin(width / 2);
      const double farther = 1 + M_PI / 4 * (seen.radius - place.radius) / distance;
      seen.x *= farther;
      seen.y *= farther;
      const double wrong = std::abs(seen.radius - place.radius);
      std::vector<PoleDetection> poles{seen};
      deskew(poles, velocity);
      EXPECT_NEAR(poles[0].radius, place.radius, 0.02 * wrong + 1e-5) << turnRate << ' ' << at.x;
      EXPECT_NEAR(poles[0].x, place.x, 1e-4);
      EXPECT_NEAR(poles[0].y, place.y, 1e-4);
      EXPECT_EQ(poles[0].turnRate, 0);
      if (std::abs(at.y) > 2) {
        EXPECT_GT(wrong, 0.002);
      }
    }
}

// Close to a fast vehicle the correction ends at half of the radius.
TEST(Deskew, RadiiStayPositive) {
  std::vector<PoleDetection> poles(1);
  poles[0].y = 0.1;
  poles[0].radius = 0.1;
  poles[0].turnRate = 10;
  deskew(poles, {30, 0, 0});
  EXPECT_DOUBLE_EQ(poles[0].radius, 0.05);
}

}  // namespace polemcl::test_deskew
