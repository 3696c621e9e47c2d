#include <tbb/global_control.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "eval/EvalApp.h"
#include "eval/GlobalTrials.h"
#include "support/TrialCity.h"

namespace polemcl::test_global_trials {

using namespace polemcl;
using namespace polemcl::apps;
using namespace testing_apps;

namespace {

class GlobalTrials : public TrialCity<RandomStartsOptions> {
 protected:
  GlobalTrials() : TrialCity(250, 12) {}
};

using Answer = GlobalTrial::Outcome;

}  // namespace

TEST_F(GlobalTrials, FindsAVehicleInItsCity) {
  std::atomic<std::size_t> told{0};
  options.progress = [&] { ++told; };
  const auto trials = runGlobalTrials(loadTrialDrive(options.files), options);
  EXPECT_EQ(told, trials.size());
  ASSERT_EQ(trials.size(), 12u);
  for (const GlobalTrial& trial : trials) {
    EXPECT_EQ(trial.outcome, Answer::right);
    EXPECT_LE(trial.error.metres, 0.5);
    EXPECT_GE(trial.metres, 2);  // a pole takes two hits
    EXPECT_LE(trial.metres, 60);
    EXPECT_LE(trial.scan, 190u);  // with 60 m still to drive
    EXPECT_FALSE(trial.okWrong);
    EXPECT_FALSE(trial.querySeconds.empty());
  }
  EXPECT_NE(trials[0].scan, trials[1].scan);
}

TEST_F(GlobalTrials, AWrongAnswerIsCalledWrong) {
  TrialDrive drive = loadTrialDrive(options.files);
  for (Pose2D& pose : drive.truth) pose.x += 1;  // so that no answer can be right
  int ok = 0;
  for (const GlobalTrial& trial : runGlobalTrials(drive, options)) {
    EXPECT_EQ(trial.outcome, Answer::wrong);
    EXPECT_NEAR(trial.error.metres, 1, 0.5);
    EXPECT_EQ(trial.okWrong, trial.okMetres.has_value());
    ok += trial.okWrong;
  }
  EXPECT_GT(ok, 6);  // said ok in the belief of a true map
}

TEST_F(GlobalTrials, OnAnotherCitysMapNothingIsFound) {
  const CityFiles other(10, 99);
  options.files.map = other.at("city.polemap");
  for (const GlobalTrial& trial : runGlobalTrials(loadTrialDrive(options.files), options))
    EXPECT_EQ(trial.outcome, Answer::undecided);
}

TEST_F(GlobalTrials, TheProgramWritesTheSameFiguresOnAnyNumberOfThreads) {
  const auto figures = [&] {
    const auto outcome = runProgram(
        evalMain, arguments("global", {"--trials", "12", "--seed", "3", "--json", city.at("j")}));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("right 12, wrong 0, undecided 0"), std::string::npos);
    EXPECT_GT(nlohmann::json::parse(readText(city.at("j_timings")))["query_max_ms"], 0);
    return nlohmann::json::parse(readText(city.at("j")));
  };
  const auto together = figures();
  EXPECT_EQ(together["right_share"], 1.0);
  EXPECT_EQ(together["ok_wrong"], 0);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(figures(), together);
}

TEST_F(GlobalTrials, RefusesWhatCannotBeTried) {
  expectFailure(runProgram(evalMain, arguments("global", {"--metres", "400"})),
                {"400", "fewer metres"});
  auto truth = io::planar(io::readTum(city.at("drive.tum")));
  truth.resize(100);
  io::writeTum(city.at("drive.tum"), truth);
  expectFailure(runProgram(evalMain, arguments("global")), {"drive.tum", "no true pose"});
  expectUsageError(runProgram(evalMain, arguments("global", {"--trials", "0"})));
}

}  // namespace polemcl::test_global_trials
