#include "support/TrialFixture.h"

namespace polemcl::test_trials {
namespace {

/// A trial of 1 m and 0.5 s a scan. Each letter is a scan: `o` ok, `d` degraded, `l` lost, `a`
/// ambiguous; a capital: with a pose 3 m off; `-`: lost without a pose.
TrialOutcome judged(const std::string& letters, std::size_t begin = 0, std::size_t end = 0) {
  Trial trial;
  trial.begin = begin;
  trial.end = end;
  std::vector<TrialScan> scans;
  for (std::size_t i = 0; i < letters.size(); ++i) {
    const char letter = letters[i], low = static_cast<char>(std::tolower(letter));
    const auto at = static_cast<double>(i);
    trial.truth.push_back({at, 0, 0});
    const double error = letter == '-' ? INFINITY : letter == low ? 0.1 : 3;
    scans.push_back({0.5 * at,
                     at,
                     {error, 0},
                     letter == '-'   ? INFINITY
                     : letter == 'O' ? 5.1
                                     : 4.9,
                     low == 'o'                 ? HealthState::ok
                     : low == 'd' || low == 'a' ? HealthState::degraded
                                                : HealthState::lost,
                     low == 'o'   ? HealthReason::none
                     : low == 'a' ? HealthReason::ambiguous
                     : low == 'd' ? HealthReason::converging
                                  : HealthReason::spread,
                     false,
                     std::nullopt});
  }
  return outcomeOf(trial, scans);
}

double metres(const std::optional<Delay>& delay) {
  return delay ? delay->metres : -1;
}

TEST(TrialOutcomes, SayWhenWhatCameToBe) {
  const TrialOutcome start = judged("-lAaDOodo");
  EXPECT_EQ(metres(start.said), 4);  // not lost, not ambiguous
  EXPECT_EQ(start.said->seconds, 2);
  EXPECT_EQ(start.saidError.metres, 3);
  EXPECT_EQ(metres(start.saidOk), 5);
  EXPECT_EQ(metres(start.ok), 6);  // with the right pose
  EXPECT_EQ(metres(start.rightForGood), 6);
  EXPECT_TRUE(start.okWrong);
  EXPECT_EQ(start.okWrongMetres, 1);
  EXPECT_EQ(start.okBeyondSeconds, 0);  // one scan
  EXPECT_EQ(judged("ooOODOOOoOl-").okBeyondSeconds, 1);
  EXPECT_EQ(start.errorMax, 3);
  EXPECT_EQ(start.endError, 0.1);
  EXPECT_EQ(metres(judged("aal").said), -1);
  EXPECT_NEAR(judged("oO").meanError, (0.1 + 3) / 2, 1e-12);
  EXPECT_EQ(metres(judged("ooO").rightForGood), -1);

  const TrialOutcome fault = judged("OooDLlDooooDoooooo" + std::string(10, 'o') + "DD", 3, 6);
  EXPECT_TRUE(fault.okBefore);
  EXPECT_EQ(metres(fault.degraded), 0);
  EXPECT_EQ(metres(fault.lost), 1);
  EXPECT_EQ(fault.lostReason, "spread");
  EXPECT_EQ(metres(fault.ok), 1);                                     // since the end
  EXPECT_EQ(metres(fault.right), 6);                                  // over the next 5 m
  EXPECT_NEAR(fault.errorAfter.value(), (20 * 0.1 + 3) / 21, 1e-12);  // over 20 m
  EXPECT_FALSE(fault.okWrong);  // what was before the fault does not count
  EXPECT_FALSE(judged("dooo", 1, 1).okBefore);
}

TEST(TrialOutcomes, CountHealthFromTheFirstOkOn) {
  const HealthCounts health = judged("-ldoddlloOdd").health;
  EXPECT_EQ(health.lostBefore, 2u);
  EXPECT_EQ(health.scans, 9u);
  EXPECT_EQ(health.ok, 3u);
  EXPECT_EQ(health.degraded, 4u);
  EXPECT_EQ(health.lost, 2u);
  EXPECT_EQ(health.lostTimes, 1u);
  EXPECT_EQ(health.degradedTimes, 2u);
  EXPECT_EQ(health.longestSeconds, 2);
  EXPECT_EQ(health.seconds, 4);
  EXPECT_EQ(health.metres, 8);
  EXPECT_EQ(health.wrongOk, 1u);
  EXPECT_EQ(health.errorMax, 3);
  EXPECT_NEAR(health.errorSum, 8 * 0.1 + 3, 1e-12);
  EXPECT_EQ(health.reasons, (std::map<std::string, std::size_t>{{"converging", 4}, {"spread", 2}}));
  EXPECT_EQ(judged("dl-").health.scans, 0u);
  EXPECT_EQ(judged("OOOddlOOoO", 10, 10).health.okBeyondSeconds, 1);
}

TEST(TrialOutcomes, PassWhatIsDemandedOfEachFault) {
  TrialOutcome outcome;
  for (const Fault fault : {Fault::kidnap, Fault::wrongMap, Fault::blind, Fault::stuck})
    EXPECT_FALSE(passes(fault, outcome));
  const auto passesWhenLost = [&](Fault fault, double seconds, double metres) {
    outcome.lost = Delay{seconds, metres};
    return passes(fault, outcome);
  };
  EXPECT_TRUE(passesWhenLost(Fault::kidnap, 6, 19));
  EXPECT_TRUE(passesWhenLost(Fault::wrongMap, 6, 19));
  EXPECT_TRUE(passesWhenLost(Fault::kidnap, 4, 30));
  EXPECT_FALSE(passesWhenLost(Fault::wrongMap, 4, 30));
  EXPECT_FALSE(passesWhenLost(Fault::kidnap, 6, 30));
  const auto passesWhenBack = [&](double seconds, double metres) {
    outcome.degraded = Delay{seconds, 50};
    outcome.ok = Delay{9, metres};
    return passes(Fault::blind, outcome);
  };
  EXPECT_TRUE(passesWhenBack(5, 20));
  EXPECT_FALSE(passesWhenBack(5.1, 20));
  EXPECT_FALSE(passesWhenBack(1, 20.1));
  outcome.ok = Delay{9, 20};
  outcome.okBeyondSeconds = 1;
  EXPECT_TRUE(passes(Fault::blind, outcome));
  outcome.okBeyondSeconds = 1.1;
  EXPECT_FALSE(passes(Fault::blind, outcome));
  TrialOutcome right;
  right.ok = Delay{1, 20};
  for (const Fault fault : {Fault::clock, Fault::moved, Fault::halfGone, Fault::snow, Fault::late})
    EXPECT_TRUE(passes(fault, right));
  right.lost = Delay{1, 1};
  EXPECT_TRUE(passes(Fault::moved, right));
  EXPECT_FALSE(passes(Fault::snow, right));
  EXPECT_FALSE(passes(Fault::halfGone, right));
  EXPECT_TRUE(passes(Fault::late, right));
  right.ok = Delay{1, 21};
  EXPECT_FALSE(passes(Fault::clock, right));
  EXPECT_FALSE(passes(Fault::late, right));
}

TEST_F(Trials, AVehicleIsFoundInItsCity) {
  const auto trials = outcomes(drive(), startsAnywhere);
  for (const TrialOutcome& trial : trials) {
    ASSERT_TRUE(trial.said);
    EXPECT_TRUE(trial.saidError.isRight());
    EXPECT_GE(trial.said->metres, 2);  // a pole takes two hits
    EXPECT_LE(trial.said->metres, 60);
    EXPECT_LE(trial.scan, 190u);  // with 60 m still to drive
    EXPECT_FALSE(trial.okWrong);
    EXPECT_FALSE(trial.searchSeconds.empty());
  }
  EXPECT_NE(trials[0].scan, trials[1].scan);
}

TEST_F(Trials, AKnownStartIsFound) {
  for (const TrialOutcome& trial : outcomes(drive(), startsNearby)) {
    ASSERT_TRUE(trial.rightForGood && trial.saidOk);
    EXPECT_LT(trial.rightForGood->metres, 20);
    EXPECT_GE(trial.saidOk->metres, 5);  // [health] confirm_m
    EXPECT_LT(trial.endError, 0.1);
    EXPECT_GT(trial.meanError, 0);
    EXPECT_LE(trial.scan, 190u);
    EXPECT_FALSE(trial.okWrong);
  }
}

TEST_F(Trials, StartsAreDrawnInTheDiscAndTheHeadingsOfTheSettings) {
  const TrialDrive whole = drive();
  const TrialMaker maker = startsNearby(whole, options);
  double farthest = 0, mostTurned = 0;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const Trial trial = maker(i);
    const PlanarError off = errorOf(trial.start.value(), trial.truth[0]);
    farthest = std::max(farthest, off.metres);
    mostTurned = std::max(mostTurned, off.radians);
    EXPECT_EQ(trial.truth[0].x, whole.truth[trial.origin].x);
    EXPECT_NEAR(trial.driven.back(), 60, 2.5);
  }
  EXPECT_LE(farthest, whole.settings.start.radius);
  EXPECT_GT(farthest, 0.5 * whole.settings.start.radius);
  EXPECT_LE(mostTurned, whole.settings.start.heading);
  EXPECT_GT(mostTurned, 0.5 * whole.settings.start.heading);
}

TEST_F(Trials, AWrongPoseIsCalledWrong) {
  TrialDrive moved = drive();
  for (Pose2D& pose : moved.truth) pose.x += 1;  // so that no answer can be right
  for (const auto maker : {startsAnywhere, startsNearby}) {
    int ok = 0;
    const auto trials = outcomes(moved, maker);
    if (maker == startsAnywhere) {
      const Json json = globalFigures(moved, options, trials).json;
      EXPECT_EQ(json["wrong"], 8);
      EXPECT_EQ(json["right"], 0);
      EXPECT_GT(json["ok_wrong"], 4);
    }
    for (const TrialOutcome& trial : trials) {
      EXPECT_FALSE(trial.rightForGood);
      EXPECT_NEAR(trial.endError, 1, 0.2);
      EXPECT_EQ(trial.okWrong, trial.saidOk.has_value());
      ok += trial.okWrong;
    }
    EXPECT_GT(ok, 4);  // said ok in the belief of a true map
  }
}

TEST_F(Trials, OnAnotherCitysMapNothingIsFound) {
  const CityFiles other(10, 99);
  options.files.map = other.at("city.polemap");
  const TrialDrive elsewhere = drive();
  const Json json = globalFigures(elsewhere, options, outcomes(elsewhere, startsAnywhere)).json;
  EXPECT_EQ(json["undecided"], 8);
  EXPECT_EQ(json["wrong"], 0);
}

TEST_F(Trials, SettingsDoNotSayWhereATrialStarts) {
  writeText(city.at("city.ini"), readText(city.at("city.ini")) + "[start]\nposition_m = 5000 0\n");
  for (const TrialOutcome& trial : outcomes(drive(), startsNearby)) EXPECT_LT(trial.endError, 0.1);
}

TEST_F(Trials, TheProgramWritesTheSameFiguresOnAnyNumberOfThreads) {
  const auto global = figures("global", {"--trials", "8"}, "right 8, wrong 0, undecided 0; ok");
  EXPECT_EQ(global["right_share"], 1.0);
  EXPECT_EQ(global["ok_wrong"], 0);
  EXPECT_GT(nlohmann::json::parse(readText(city.at("j_timings")))["query_max_ms"], 0);
  const auto starts =
      figures("starts", {"--trials", "8"}, "right at the end 8; ok said of a wrong pose: 0");
  EXPECT_EQ(starts["right_share"], 1.0);
  EXPECT_EQ(starts["trials"], 8);
}

TEST_F(Trials, RefuseWhatCannotBeTried) {
  for (const char* command : {"global", "starts"}) {
    expectFailure(run(command, {"--metres", "400"}), {"400", "fewer metres"});
    expectUsageError(run(command, {"--trials", "0"}));
  }
  expectFailure(run("faults", {"--fault", "wrong-map"}), {"--other-map"});
  expectFailure(run("faults", {"--fault", "blind", "--tail", "4000"}), {"too short"});
  for (const char* bad : {"nan", "0", "-1", "inf", "1e7"})
    expectUsageError(run("faults", {"--fault", "blind", "--duration", bad}));
  expectUsageError(run("faults", {"--fault", "flood"}));
  expectUsageError(run("faults"));
  auto truth = io::planar(io::readTum(city.at("drive.tum")));
  truth.resize(100);
  io::writeTum(city.at("drive.tum"), truth);
  expectFailure(run("global"), {"drive.tum", "no true pose"});
}

TEST_F(FaultTrials, FaultsAreNoticedAndRecoveredFrom) {
  for (const Fault fault : {Fault::kidnap, Fault::blind, Fault::stuck, Fault::jump, Fault::clock,
                            Fault::moved, Fault::halfGone, Fault::snow, Fault::late}) {
    options.fault.fault = fault;
    for (const TrialOutcome& trial : outcomes(drive(), faultyStretches)) {
      EXPECT_TRUE(trial.okBefore);
      EXPECT_TRUE(passes(fault, trial)) << name(fault) << " at " << trial.scan;
      ASSERT_TRUE(trial.ok);
      EXPECT_LT(trial.errorAfter.value(), 0.2);
    }
  }
}

TEST_F(FaultTrials, AWrongMapIsNoticed) {
  const CityFiles other(20, 77);
  const auto json = figures("faults",
                            {"--fault", "wrong-map", "--other-map", other.at("city.polemap"),
                             "--trials", "3", "--tail", "60"},
                            "fault wrong-map: 3 of 3 as demanded; ok before the fault: 0\n");
  EXPECT_EQ(json["lost"]["trials"], 3);
  EXPECT_EQ(json["ok"]["trials"], 0);
}

TEST_F(FaultTrials, AHealthyDriveIsOk) {
  const auto json = figures("faults", {"--fault", "none", "--trials", "2"}, "no fault: 2 runs, ");
  EXPECT_EQ(json["runs"], 2);
  EXPECT_EQ(json["lost_times"], 0);
  EXPECT_EQ(json["ok_with_wrong_pose"], 0);
  const double scans = json["scans"];
  EXPECT_GT(scans * json["ok_share"].get<double>(), 2 * 350);
  EXPECT_NEAR(json["hours"].get<double>() * 3600, 0.2 * (scans - 2), 1e-3);
  EXPECT_NEAR(json["kilometres"].get<double>() * 1000, scans - 2, 10);
}

TEST_F(FaultTrials, TheProgramListsWhatFailed) {
  const auto json = figures(
      "faults",
      {"--fault", "slip", "--trials", "3", "--lead", "8", "--duration", "4", "--tail", "40"},
      "\nright     ");
  EXPECT_EQ(json["trials"], 3);
  EXPECT_EQ(json["passed"].get<int>() + json["failed"].size(), 3u);
}

}  // namespace
}  // namespace polemcl::test_trials
