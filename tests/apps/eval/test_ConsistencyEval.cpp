#include <nlohmann/json.hpp>

#include <polemcl/core/common/Types.h>
#include "eval/ConsistencyEval.h"
#include "eval/EvalApp.h"
#include "support/TempFolder.h"

namespace polemcl::test_consistency_eval {

using namespace polemcl;
using namespace polemcl::apps;
using namespace testing_apps;

namespace {

const std::string covHeader = "scan,timestamp,x_m,y_m,yaw_rad,xx,xy,xyaw,yy,yyaw,yawyaw\n";

/// Truth along x at 1 m and 1 s a pose; estimates off by `dy` with a standard deviation of 0.1 m.
class ConsistencyEval : public testing::Test {
 protected:
  void writeTruth(int poses) {
    std::string rows;
    for (int i = 0; i < poses; ++i)
      rows += std::to_string(i) + " " + std::to_string(i) + " 0 0 0 0 0 1\n";
    writeText(folder / "truth.tum", rows);
  }
  void writeCov(const std::string& name, int poses, double dy, double firstDy) {
    std::string rows = covHeader;
    for (int i = 0; i < poses; ++i)
      rows += std::to_string(i) + "," + std::to_string(i) + "," + std::to_string(i) + "," +
              std::to_string(i < 10 ? firstDy : dy) + ",0,0.01,0,0,0.01,0,0.0001\n";
    writeText(folder / name, rows);
  }
  std::string at(const std::string& name) { return (folder / name).string(); }
  Outcome run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "consistency");
    return runProgram(evalMain, arguments);
  }
  TempFolder folder;
};

}  // namespace

TEST_F(ConsistencyEval, LeavesOutWhatComesBeforeConvergence) {
  writeTruth(30);
  writeCov("run_00_cov.csv", 30, 0.1, 5);  // 25 m² / 0.01 before, 1 after
  writeCov("run_01_cov.csv", 20, 0.3, 5);  // 9 after: beyond the ellipse
  const auto outcome = run({"--truth", at("truth.tum"), "--cov", at("run_00_cov.csv"),
                            at("run_01_cov.csv"), "--skip-metres", "10", "--json", at("c.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(readText(folder / "c.json"));
  ASSERT_EQ(json["runs"].size(), 2u);
  EXPECT_EQ(json["runs"][0]["poses"], 20);
  EXPECT_NEAR(json["runs"][0]["nees_mean"], 1, 1e-6);
  EXPECT_NEAR(json["runs"][1]["nees_mean"], 9, 1e-6);
  EXPECT_NEAR(json["nees_mean"], (20 * 1 + 10 * 9) / 30.0, 1e-6);
  EXPECT_NEAR(json["coverage_95"], 2.0 / 3, 1e-9);
  const auto later = run({"--truth", at("truth.tum"), "--cov", at("run_00_cov.csv"),
                          "--skip-metres", "0", "--skip-seconds", "9", "--json", at("s.json")});
  ASSERT_EQ(later.code, 0) << later.err;
  EXPECT_EQ(nlohmann::json::parse(readText(folder / "s.json"))["poses"], 21);
}

TEST_F(ConsistencyEval, CountsOnlyWhatIsOkWhenToldTheHealth) {
  writeTruth(30);
  writeCov("cov.csv", 40, 0.1, 5);
  std::string health = "scan,state\n";
  for (int i = 0; i < 40; ++i)
    health += std::to_string(i) + (i < 10 || i == 12 ? ",degraded\n" : ",ok\n");
  writeText(folder / "health.csv", health);
  EvalConsistencyOptions options;
  options.truth = {folder / "truth.tum"};
  options.cov = {folder / "cov.csv"};
  options.health = {folder / "health.csv"};
  options.skipMetres = 0;
  const auto result = evalConsistency(options);
  EXPECT_EQ(result.all.samples, 19u);
  EXPECT_EQ(result.notOk, 11u);
  EXPECT_EQ(result.unmatched, 10u);
  EXPECT_NEAR(result.all.neesMean, 1, 1e-6);
  EXPECT_EQ(result.all.longestBeyond5, 0);
  writeCov("cov.csv", 40, 0.6, 5);
  EXPECT_NEAR(evalConsistency(options).all.longestBeyond5, 29 - 13, 1e-9)
      << "12 is not ok, the truth ends with 29";
  std::string rows;  // the truth again, without 20 to 22
  for (int i = 0; i < 30; ++i)
    if (i < 20 || i > 22) rows += std::to_string(i) + " " + std::to_string(i) + " 0 0 0 0 0 1\n";
  writeText(folder / "truth.tum", rows);
  EXPECT_NEAR(evalConsistency(options).all.longestBeyond5, 29 - 23, 1e-9);
}

TEST_F(ConsistencyEval, AddsTheUncertaintyOfTheTruth) {
  writeTruth(30);
  writeCov("cov.csv", 30, 0.2, 0.2);
  const auto outcome = run({"--truth", at("truth.tum"), "--cov", at("cov.csv"), "--truth-sigma-m",
                            "0.1", "--truth-sigma-deg", "1", "--json", at("c.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(readText(folder / "c.json"));
  EXPECT_NEAR(json["nees_mean"], 0.04 / 0.02, 1e-9);  // 4 without
  EXPECT_NEAR(json["truth_sigma_deg"], 1, 1e-12);
}

TEST_F(ConsistencyEval, RefusesWhatDoesNotFitTogether) {
  writeTruth(30);
  writeCov("cov.csv", 30, 0.1, 5);
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"--truth", at("truth.tum"), "--cov", at("cov.csv")});
    return run(more);
  };
  expectFailure(with({"--skip-metres", "1000"}), {"cov.csv", "no pose is left"});
  expectFailure(with({"--truth", at("truth.tum"), at("truth.tum")}), {"3 truths", "1 runs"});
  writeText(folder / "short.csv", "scan,state\n0,ok\n");
  expectFailure(with({"--health", at("short.csv")}), {"short.csv", "no scan"});
  writeText(folder / "odd.csv", "scan,state\n4,ok\n");
  expectFailure(with({"--health", at("odd.csv")}), {"odd.csv:2", "scan 0 expected"});
  expectFailure(with({"--health", at("odd.csv"), at("odd.csv")}), {"2 health files"});
  expectUsageError(with({"--truth-sigma-m", "-1"}));
  writeText(folder / "flat.csv", covHeader + "0,0,0,0,0,0,0,0,0,0,0\n");
  expectFailure(run({"--truth", at("truth.tum"), "--cov", at("flat.csv"), "--skip-metres", "0"}),
                {"flat.csv", "positive definite"});
  writeText(folder / "other.csv", "scan,timestamp\n0,0\n");
  expectFailure(run({"--truth", at("truth.tum"), "--cov", at("other.csv")}), {"other.csv", "x_m"});
  expectUsageError(run({"--truth", at("truth.tum")}));
}

}  // namespace polemcl::test_consistency_eval
