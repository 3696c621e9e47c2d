#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/RawlogActions.h"
#include "eval/EvalApp.h"
#include "eval/MotionEval.h"
#include "mrpt/rawlog/RawlogWriter.h"
#include "support/StreetTest.h"

namespace polemcl::test_motion_eval {

using namespace polemcl;
using namespace polemcl::apps;
using namespace testing_apps;

namespace {

constexpr double s_step = 0.4, s_turn = 0.02;

/// A robot on a curve that sees twelve poles standing round it, its odometry 10 % long.
class MotionEvalTest : public StreetTest {
 protected:
  Outcome run(const std::vector<std::string>& arguments) { return runProgram(evalMain, arguments); }

  void writeDrive(std::size_t scans, bool odometry = true) {
    RawlogWriter writer((folder / "p.rawlog").string());
    Pose2D pose;
    for (std::size_t i = 0; i < scans; ++i) {
      auto scan = std::make_shared<CObservationPoles>();
      scan->timestamp = mrpt::Clock::fromDouble(static_cast<double>(i));
      for (int k = 0; k < 12; ++k) {
        const double range = 8 + 2.5 * k, angle = 1.7 * k;
        const Pose2D seen = relative(pose, {range * std::cos(angle), range * std::sin(angle), 0});
        PoleDetection pole;
        pole.x = seen.x;
        pole.y = seen.y;
        pole.confidence = 0.9;
        pole.covariance = Eigen::Matrix2d::Identity() * 1e-4;
        scan->poles.push_back(pole);
      }
      PoseWithCovariance motion;
      motion.mean = i == 0 ? Pose2D() : Pose2D{1.1 * s_step, 0, s_turn};
      motion.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
      writer.write(odometry ? makeActions(motion, scan->timestamp) : mrpt::obs::CActionCollection(),
                   scan);
      pose = compose(pose, {s_step, 0, s_turn});
    }
    writer.commit();
  }

  /// Poses on the same curve, each step longer by this factor.
  void writeTruth(std::size_t poses, double scale) {
    std::ostringstream rows;
    Pose2D pose;
    for (std::size_t i = 0; i < poses; ++i) {
      rows << i << ' ' << pose.x << ' ' << pose.y << " 0 0 0 " << std::sin(pose.yaw / 2) << ' '
           << std::cos(pose.yaw / 2) << '\n';
      pose = compose(pose, {scale * s_step, 0, s_turn});
    }
    writeText(folder / "t.tum", rows.str());
  }

  std::vector<MotionComparison> compare(std::size_t every) {
    EvalMotionOptions options;
    options.poles = folder / "p.rawlog";
    options.truth = folder / "t.tum";
    options.every = every;
    options.json = folder / "m.json";
    return evalMotion(options);
  }
};

double metres(const Pose2D& motion) {
  return std::hypot(motion.x, motion.y);
}

}  // namespace

TEST_F(MotionEvalTest, PolesTellTheMotionWhateverTruthAndOdometrySay) {
  writeDrive(13);
  writeTruth(13, 0.95);
  Pose2D moved, odometry;
  for (int i = 0; i < 4; ++i) {
    moved = compose(moved, {s_step, 0, s_turn});
    odometry = compose(odometry, {1.1 * s_step, 0, s_turn});
  }
  const auto stretches = compare(4);
  ASSERT_EQ(stretches.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(stretches[i].scan, 4 * i);
    EXPECT_NEAR(metres(stretches[i].truth), 0.95 * metres(moved), 1e-3);
    EXPECT_EQ(stretches[i].poles.pairs, 12);
    EXPECT_NEAR(stretches[i].poles.motion.x, moved.x, 1e-6);
    EXPECT_NEAR(stretches[i].poles.motion.y, moved.y, 1e-6);
    EXPECT_NEAR(stretches[i].poles.motion.yaw, moved.yaw, 1e-7);
    ASSERT_TRUE(stretches[i].odometry);
    EXPECT_NEAR(stretches[i].odometry->x, odometry.x, 1e-6);
  }
  const auto json = nlohmann::json::parse(readText(folder / "m.json"));
  ASSERT_EQ(json.size(), 3u);
  EXPECT_NEAR(json[2]["poles"]["m"], metres(moved), 1e-6);
  EXPECT_NEAR(json[2]["odometry"]["m"], 1.1 * metres(moved), 0.002);
}

TEST_F(MotionEvalTest, TheTableSumsUpWhatThePolesSayMore) {
  writeDrive(5, false);
  writeTruth(5, 0.5);
  const auto outcome = run({"motion", "--poles", (folder / "p.rawlog").string(), "--truth",
                            (folder / "t.tum").string(), "--every", "2"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("the poles say 0.800 m and 0.00 deg more than the truth, over 0.8 m"),
            std::string::npos)
      << outcome.out;
  EXPECT_FALSE(compare(2)[0].odometry);
}

TEST_F(MotionEvalTest, EndsWithAVerdict) {
  writeDrive(13);
  const auto verdict = [this](double scale) {
    writeTruth(13, scale);
    return run({"motion", "--poles", at("p.rawlog"), "--truth", at("t.tum")}).out;
  };
  EXPECT_NE(verdict(1).find("\nthe poles agree with these poses (in 3 of 3 stretches)\n"),
            std::string::npos);
  EXPECT_NE(verdict(0.9).find("\nthe poles contradict these poses: truth of another drive, wrong "
                              "time or wrong scan timing (in 3 of 3 stretches)\n"),
            std::string::npos);
  // 6.4 m too far: farther off than pairs are looked for around the true motion.
  EXPECT_NE(verdict(5).find("(in 3 of 3 stretches)\n"), std::string::npos);
  writeTruth(13, 1);
  EXPECT_NE(run({"motion", "--poles", at("p.rawlog"), "--truth", at("t.tum"), "--every", "12"})
                .out.find("agree with these poses (in 1 of 1"),
            std::string::npos);
}

TEST_F(MotionEvalTest, RefusesWhatCannotBeCompared) {
  writeDrive(5);
  writeTruth(3, 1);
  const std::string poles = (folder / "p.rawlog").string(), truth = (folder / "t.tum").string();
  expectFailure(run({"motion", "--poles", poles, "--truth", truth, "--every", "1"}),
                {truth, "3.0", "scan 3"});
  writeTruth(5, 1);
  expectFailure(run({"motion", "--poles", poles, "--truth", truth, "--every", "5"}),
                {poles, "fewer than two scans"});
  expectUsageError(run({"motion", "--poles", poles}));
  expectUsageError(run({"motion", "--poles", poles, "--truth", truth, "--every", "0"}));
}

}  // namespace polemcl::test_motion_eval
