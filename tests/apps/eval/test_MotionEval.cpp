#include <cmath>
#include <sstream>

#include "support/EvalTest.h"

namespace polemcl::test_motion_eval {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

constexpr double kStep = 0.4, kTurn = 0.02;

/// A robot on a curve that sees twelve poles standing round it, its odometry 10 % long.
class MotionEvalTest : public EvalTest {
 protected:
  static Pose2D wayAfter(std::size_t steps, double scale = 1) {
    Pose2D pose;
    for (std::size_t i = 0; i < steps; ++i) pose = compose(pose, {scale * kStep, 0, kTurn});
    return pose;
  }
  static double metresAfter(std::size_t steps, double scale = 1) {
    const Pose2D pose = wayAfter(steps, scale);
    return std::hypot(pose.x, pose.y);
  }

  void writeDrive(std::size_t scans, bool odometry = true) const {
    std::vector<double> times;
    for (std::size_t i = 0; i < scans; ++i) times.push_back(static_cast<double>(i));
    PoseWithCovariance motion;
    motion.mean = {1.1 * kStep, 0, kTurn};
    motion.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
    writePoles(
        "p.rawlog", times,
        [](std::size_t i) {
          Poles poles;
          for (int k = 0; k < 12; ++k) {
            const double range = 8 + 2.5 * k, angle = 1.7 * k;
            const Pose2D seen =
                relative(wayAfter(i), {range * std::cos(angle), range * std::sin(angle), 0});
            poles.push_back(detection(seen.x, seen.y));
            poles.back().covariance = Eigen::Matrix2d::Identity() * 1e-4;
          }
          return poles;
        },
        odometry ? std::optional(motion) : std::nullopt);
  }
  /// Poses on the same curve, each step longer by this factor.
  void writeTruth(std::size_t poses, double scale) const {
    std::ostringstream rows;
    for (std::size_t i = 0; i < poses; ++i) {
      const Pose2D pose = wayAfter(i, scale);
      rows << i << ' ' << pose.x << ' ' << pose.y << " 0 0 0 " << std::sin(pose.yaw / 2) << ' '
           << std::cos(pose.yaw / 2) << '\n';
    }
    writeText(at("t.tum"), rows.str());
  }
  Arguments motion(const std::string& every = "4") const {
    return {"motion", "--poles", at("p.rawlog"), "--truth", at("t.tum"), "--every", every};
  }
  void expectText(const std::string& words, const std::string& every = "4") const {
    const Outcome outcome = succeeded(run(motion(every)));
    EXPECT_NE(outcome.out.find(words), std::string::npos) << outcome.out;
  }
};

TEST_F(MotionEvalTest, PolesTellTheMotionWhateverTruthAndOdometrySay) {
  writeDrive(13);
  writeTruth(13, 0.95);
  const auto stretches = figures(motion());
  ASSERT_EQ(stretches.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& stretch = stretches[i];
    EXPECT_EQ(stretch["scan"], 4 * i);
    EXPECT_NEAR(stretch["truth"]["m"], 0.95 * metresAfter(4), 1e-3);
    EXPECT_EQ(stretch["pairs"], 12);
    EXPECT_NEAR(stretch["poles"]["m"], metresAfter(4), 1e-6);
    EXPECT_NEAR(stretch["poles"]["deg"], 4 * kTurn * 180 / M_PI, 1e-5);
    EXPECT_NEAR(stretch["odometry"]["m"], metresAfter(4, 1.1), 1e-6);
  }
}

TEST_F(MotionEvalTest, TheTableSumsUpWhatThePolesSayMore) {
  writeDrive(5, false);
  writeTruth(5, 0.5);
  expectText("    0    0.400    2.29                -    0.800    2.29     12\n", "2");
  expectText("the poles say 0.800 m and 0.00 deg more than the truth, over 0.8 m", "2");
  EXPECT_TRUE(figures(motion("2"))[0]["odometry"].is_null());
}

TEST_F(MotionEvalTest, EndsWithAVerdict) {
  writeDrive(13);
  writeTruth(13, 1);
  expectText("\nthe poles agree with these poses (in 3 of 3 stretches)\n");
  expectText("agree with these poses (in 3 of 3", "12");  // as pole-map, whatever --every
  writeTruth(13, 0.9);
  expectText(
      "\nthe poles contradict these poses: truth of another drive or in another frame, wrong time "
      "or wrong scan timing "
      "(in 3 of 3 stretches)\n");
  writeTruth(13, 5);  // 6.4 m too far: farther off than pairs are looked for around the true motion
  expectText("(in 3 of 3 stretches)\n");
}

TEST_F(MotionEvalTest, RefusesWhatCannotBeCompared) {
  writeDrive(5);
  writeTruth(3, 1);
  expectFailure(run(motion("1")), {at("t.tum"), "3.0", "scan 3"});
  writeTruth(5, 1);
  expectFailure(run(motion("5")), {at("p.rawlog"), "fewer than two scans"});
  expectUsageError(run({"motion", "--poles", at("p.rawlog")}));
  expectUsageError(run(motion("0")));
}

}  // namespace
}  // namespace polemcl::test_motion_eval
