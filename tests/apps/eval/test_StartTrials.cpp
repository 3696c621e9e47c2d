#include <tbb/global_control.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "eval/EvalApp.h"
#include "eval/StartTrials.h"
#include "mrpt/map/RegisterClasses.h"
#include "support/CityFiles.h"

namespace polemcl::test_start_trials {

using namespace polemcl;
using namespace polemcl::apps;
using namespace testing_apps;

namespace {

class StartTrials : public testing::Test {
 protected:
  StartTrials() : city(250) {
    registerClasses();
    options.files = {city.at("city.ini"), city.at("city.polemap"), city.at("drive.rawlog"),
                     city.at("drive.tum")};
    options.trials = 8;
    options.seed = 3;
  }
  std::vector<std::string> arguments(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"starts",
                                 "--config",
                                 options.files.config.string(),
                                 "--map",
                                 options.files.map.string(),
                                 "--input",
                                 options.files.input.string(),
                                 "--truth",
                                 options.files.truth.string()};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  CityFiles city;
  StartTrialsOptions options;
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
    const auto outcome =
        runProgram(evalMain, arguments({"--trials", "8", "--seed", "3", "--json", city.at("j")}));
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
  expectFailure(runProgram(evalMain, arguments({"--metres", "400"})), {"400", "fewer metres"});
  expectUsageError(runProgram(evalMain, arguments({"--trials", "0"})));
}

}  // namespace polemcl::test_start_trials
