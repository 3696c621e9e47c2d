#include <tbb/global_control.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "eval/EvalApp.h"
#include "eval/StartTrials.h"
#include "support/TrialCity.h"

namespace polemcl::test_start_trials {

using namespace polemcl;
using namespace polemcl::apps;
using namespace testing_apps;

namespace {

class StartTrials : public TrialCity<RandomStartsOptions> {
 protected:
  StartTrials() : TrialCity(250, 8) {}
};

}  // namespace

TEST_F(StartTrials, FindThePose) {
  std::atomic<std::size_t> told{0};
  options.progress = [&] { ++told; };
  const auto trials = runStartTrials(loadTrialDrive(options.files), options);
  EXPECT_EQ(told, trials.size());
  ASSERT_EQ(trials.size(), 8u);
  for (const StartTrial& trial : trials) {
    ASSERT_TRUE(trial.rightMetres && trial.okMetres);
    EXPECT_LT(*trial.rightMetres, 20);
    EXPECT_GE(*trial.okMetres, 5);  // [health] confirm_m
    EXPECT_LT(trial.endError, 0.1);
    EXPECT_GT(trial.meanError, 0);
    EXPECT_LE(trial.scan, 190u);  // with 60 m still to drive
    EXPECT_FALSE(trial.okWrong);
  }
  EXPECT_NE(trials[0].scan, trials[1].scan);
}

TEST_F(StartTrials, AWrongPoseIsCalledWrong) {
  TrialDrive drive = loadTrialDrive(options.files);
  for (Pose2D& pose : drive.truth) pose.x += 1;  // within the disc: the filter finds the map's pose
  int ok = 0;
  for (const StartTrial& trial : runStartTrials(drive, options)) {
    EXPECT_FALSE(trial.rightMetres);
    EXPECT_NEAR(trial.endError, 1, 0.2);
    EXPECT_EQ(trial.okWrong, trial.okMetres.has_value());
    ok += trial.okWrong;
  }
  EXPECT_GT(ok, 4);
}

TEST_F(StartTrials, TheProgramWritesTheSameFiguresOnAnyNumberOfThreads) {
  const auto figures = [&] {
    const auto outcome = runProgram(
        evalMain, arguments("starts", {"--trials", "8", "--seed", "3", "--json", city.at("j")}));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("right at the end 8; ok said of a wrong pose: 0"),
              std::string::npos);
    return nlohmann::json::parse(readText(city.at("j")));
  };
  const auto together = figures();
  EXPECT_EQ(together["right_share"], 1.0);
  EXPECT_EQ(together["trials"], 8);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(figures(), together);
}

TEST_F(StartTrials, RefuseWhatCannotBeTried) {
  expectFailure(runProgram(evalMain, arguments("starts", {"--metres", "400"})),
                {"400", "fewer metres"});
  expectUsageError(runProgram(evalMain, arguments("starts", {"--trials", "0"})));
}

}  // namespace polemcl::test_start_trials
