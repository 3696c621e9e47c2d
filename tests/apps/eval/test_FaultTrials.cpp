#include <tbb/global_control.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "eval/EvalApp.h"
#include "eval/FaultTrials.h"
#include "support/TrialCity.h"

namespace polemcl::test_fault_trials {

using namespace polemcl;
using namespace polemcl::apps;
using namespace testing_apps;

namespace {

/// A frame a metre, 5 m/s.
class FaultTrials : public TrialCity<FaultTrialsOptions> {
 protected:
  FaultTrials() : TrialCity(400, 6) {
    options.fault.lead = 8;
    options.fault.duration = 6;
    options.fault.tail = 60;
    options.fault.maxJump = 200;
  }
  TrialDrive drive() const { return loadTrialDrive(options.files); }
  FaultyDrive inject(Fault fault, std::uint64_t seed = 1) {
    options.fault.fault = fault;
    std::mt19937_64 random(seed);
    return injectFault(drive(), options.fault, random);
  }
};

}  // namespace

TEST_F(FaultTrials, WindowsHoldLeadFaultAndTail) {
  const TrialDrive whole = drive();
  int longer = 0;
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    options.fault.fault = Fault::slip;
    std::mt19937_64 random(seed);
    const FaultyDrive slip = injectFault(whole, options.fault, random);
    EXPECT_EQ(slip.begin, 40u);  // 8 s of 0.2 s
    EXPECT_EQ(slip.end, 70u);
    ASSERT_EQ(slip.frames.size(), slip.truth.size());
    EXPECT_NEAR(slip.driven.back() - slip.driven[slip.end], 60, 2.5);
    const auto factorOf = [&](std::size_t i) {
      return slip.frames[i].motion->mean.x / whole.frames[slip.origin + i].motion->mean.x;
    };
    const double slipping = factorOf(slip.begin);
    EXPECT_NEAR(std::abs(slipping - 1), 0.2, 1e-6);
    longer += slipping > 1;
    for (std::size_t i = 1; i < slip.frames.size(); ++i) {
      const double factor = i >= slip.begin && i < slip.end ? slipping : 1;
      EXPECT_NEAR(factorOf(i), factor, 1e-6) << i;
      const PoseWithCovariance& before = *whole.frames[slip.origin + i].motion;
      EXPECT_TRUE(slip.frames[i].motion->covariance.isApprox(factor * factor * before.covariance))
          << i;
      EXPECT_NEAR(slip.frames[i].time - slip.frames[i - 1].time, 0.2, 1e-5);
      EXPECT_EQ(slip.truth[i].x, whole.truth[slip.origin + i].x);
    }
  }
  EXPECT_GT(longer, 3);  // of 19: half, by chance
  EXPECT_LT(longer, 16);
}

TEST_F(FaultTrials, EachFaultSpoilsItsOwn) {
  const FaultyDrive blind = inject(Fault::blind), stuck = inject(Fault::stuck);
  for (std::size_t i = 1; i < blind.frames.size(); ++i) {
    const bool faulty = i >= blind.begin && i < blind.end;
    EXPECT_EQ(blind.frames[i].poles_robot.empty(), faulty) << i;
  }
  for (std::size_t i = 1; i < stuck.frames.size(); ++i) {
    const bool faulty = i >= stuck.begin && i < stuck.end;
    EXPECT_EQ(stuck.frames[i].motion->mean.x == 0, faulty) << i;
    // It is sure of standing still.
    const double sigma = std::sqrt(stuck.frames[i].motion->covariance(0, 0));
    EXPECT_EQ(sigma <= io::motionFloorMetres * (1 + 1e-9), faulty) << i << ' ' << sigma;
  }
}

TEST_F(FaultTrials, AKidnappingJumpsAsFarAsToldAndTimeGoesOn) {
  for (std::uint64_t seed = 1; seed < 8; ++seed) {
    const FaultyDrive jump = inject(Fault::kidnap, seed);
    const double distance = errorOf(jump.truth[jump.begin], jump.truth[jump.begin - 1]).metres;
    EXPECT_GT(distance, 18);
    EXPECT_LT(distance, 202);
    EXPECT_NEAR(jump.jump, distance, 2);
    for (std::size_t i = 1; i < jump.frames.size(); ++i)
      EXPECT_NEAR(jump.frames[i].time - jump.frames[i - 1].time, 0.2, 1e-5);
    EXPECT_LT(std::abs(jump.frames[jump.begin].motion->mean.x), 2);  // nothing of the jump
  }
}

TEST_F(FaultTrials, FaultsAreNoticedAndRecoveredFrom) {
  for (const Fault fault : {Fault::kidnap, Fault::blind, Fault::stuck}) {
    options.fault.fault = fault;
    const auto trials = runFaultTrials(drive(), options);
    ASSERT_EQ(trials.size(), 6u);
    for (const FaultTrial& trial : trials) {
      EXPECT_TRUE(trial.okBefore);
      EXPECT_TRUE(trial.passed) << name(fault) << " at " << trial.scan;
      ASSERT_TRUE(trial.ok);
      EXPECT_LT(trial.errorAfter, 0.2);
    }
  }
}

TEST_F(FaultTrials, AWrongMapIsNoticed) {
  const CityFiles other(20, 77);
  options.fault.fault = Fault::wrongMap;
  options.otherMap = other.at("city.polemap");
  for (const FaultTrial& trial : runFaultTrials(drive(), options)) {
    EXPECT_TRUE(trial.passed) << trial.scan;
    EXPECT_FALSE(trial.ok);
  }
}

TEST_F(FaultTrials, AHealthyDriveIsOk) {
  std::atomic<std::size_t> told{0};
  options.progress = [&] { ++told; };
  const auto runs = runHealthy(drive(), options);
  EXPECT_EQ(told, runs.size());
  ASSERT_EQ(runs.size(), 6u);
  for (const HealthyRun& run : runs) {
    EXPECT_EQ(run.lostTimes, 0u);
    EXPECT_EQ(run.wrongOk, 0u);
    EXPECT_GT(run.ok, 350u);
    EXPECT_EQ(run.scans, run.ok + run.degraded + run.lost);
    EXPECT_NEAR(run.seconds, 0.2 * static_cast<double>(run.scans - 1), 1e-3);
    EXPECT_NEAR(run.metres, static_cast<double>(run.scans - 1), 5);
  }
}

TEST_F(FaultTrials, TheSameFiguresOnAnyNumberOfThreads) {
  options.fault.fault = Fault::stuck;
  options.trials = 3;
  const TrialDrive once = drive();
  const auto many = runFaultTrials(once, options);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto single = runFaultTrials(once, options);
  for (std::size_t i = 0; i < many.size(); ++i) {
    EXPECT_EQ(many[i].scan, single[i].scan);
    EXPECT_EQ(many[i].errorMax, single[i].errorMax);
    EXPECT_EQ(many[i].errorAfter, single[i].errorAfter);
  }
}

TEST(FaultDemands, AreThoseOfEachFault) {
  FaultTrial trial;
  for (const Fault fault : {Fault::kidnap, Fault::wrongMap, Fault::blind, Fault::stuck})
    EXPECT_FALSE(passes(fault, trial));
  trial.lost = Delay{6, 19};
  EXPECT_TRUE(passes(Fault::kidnap, trial));
  EXPECT_TRUE(passes(Fault::wrongMap, trial));
  trial.lost = Delay{4, 30};
  EXPECT_TRUE(passes(Fault::kidnap, trial));
  EXPECT_FALSE(passes(Fault::wrongMap, trial));
  trial.lost = Delay{6, 30};
  EXPECT_FALSE(passes(Fault::kidnap, trial));
  trial.degraded = Delay{5, 50};
  trial.ok = Delay{9, 20};
  EXPECT_TRUE(passes(Fault::blind, trial));
  trial.degraded->seconds = 5.1;
  EXPECT_FALSE(passes(Fault::blind, trial));
  trial.degraded->seconds = 1;
  trial.ok->metres = 20.1;
  EXPECT_FALSE(passes(Fault::slip, trial));
}

TEST_F(FaultTrials, TheProgramWritesTableAndJson) {
  const auto with = [&](const std::vector<std::string>& more) {
    return runProgram(evalMain, arguments("faults", more));
  };
  auto outcome = with({"--fault", "slip", "--trials", "2", "--lead", "8", "--duration", "4",
                       "--tail", "40", "--json", city.at("slip.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("fault slip"), std::string::npos);
  const auto json = nlohmann::json::parse(readText(city.folder / "slip.json"));
  EXPECT_EQ(json["trials"], 2);
  EXPECT_EQ(json["passed"].get<int>() + json["failed"].size(), 2u);
  outcome = with({"--fault", "none", "--trials", "1", "--json", city.at("none.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(readText(city.folder / "none.json"))["lost_times"], 0);
  expectFailure(with({"--fault", "wrong-map", "--trials", "1"}), {"--other-map"});
  expectFailure(with({"--fault", "blind", "--tail", "4000"}), {"too short"});
  for (const char* bad : {"nan", "0", "-1", "inf", "1e7"})
    expectUsageError(with({"--fault", "blind", "--duration", bad}));
  expectUsageError(with({"--fault", "flood"}));
  expectUsageError(with({}));
}

}  // namespace polemcl::test_fault_trials
