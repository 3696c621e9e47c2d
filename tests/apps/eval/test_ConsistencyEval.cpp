#include "support/EvalTest.h"

namespace polemcl::test_consistency_eval {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

const std::string covHeader = "scan,timestamp,x_m,y_m,yaw_rad,xx,xy,xyaw,yy,yyaw,yawyaw\n";

/// Truth along x at 1 m and 1 s a pose; estimates off by `dy` with a standard deviation of 0.1 m.
class ConsistencyEval : public EvalTest {
 protected:
  ConsistencyEval() { writeWay("truth.tum", 30); }
  void writeCov(const std::string& name, int poses, double dy, double firstDy) const {
    std::string rows = covHeader;
    for (int i = 0; i < poses; ++i) {
      const std::string number = std::to_string(i);
      rows += number + "," + number + "," + number + "," + std::to_string(i < 10 ? firstDy : dy) +
              ",0,0.01,0,0,0.01,0,0.0001\n";
    }
    writeText(at(name), rows);
  }
  Arguments with(const std::string& cov, const Arguments& more = {}) const {
    Arguments all{"consistency", "--truth", at("truth.tum"), "--cov", at(cov)};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

TEST_F(ConsistencyEval, LeavesOutWhatComesBeforeConvergence) {
  writeCov("run_00_cov.csv", 30, 0.1, 5);  // 25 m² / 0.01 before, 1 after
  writeCov("run_01_cov.csv", 20, 0.3, 5);  // 9 after: beyond the ellipse
  const auto json = figures(with("run_00_cov.csv", {at("run_01_cov.csv"), "--skip-metres", "10"}));
  ASSERT_EQ(json["runs"].size(), 2u);
  EXPECT_EQ(json["runs"][0]["poses"], 20);
  EXPECT_NEAR(json["runs"][0]["nees_mean"], 1, 1e-6);
  EXPECT_NEAR(json["runs"][1]["nees_mean"], 9, 1e-6);
  EXPECT_NEAR(json["nees_mean"], (20 * 1 + 10 * 9) / 30.0, 1e-6);
  EXPECT_NEAR(json["coverage_95"], 2.0 / 3, 1e-9);
  EXPECT_EQ(figures(with("run_00_cov.csv", {"--skip-metres", "0", "--skip-seconds", "9"}))["poses"],
            21);
}

TEST_F(ConsistencyEval, CountsOnlyWhatIsOkWhenToldTheHealth) {
  writeCov("cov.csv", 40, 0.1, 5);
  std::string health = "scan,state\n";
  for (int i = 0; i < 40; ++i)
    health += std::to_string(i) + (i < 10 || i == 12 ? ",degraded\n" : ",ok\n");
  writeText(at("health.csv"), health);
  const Arguments command = with("cov.csv", {"--health", at("health.csv"), "--skip-metres", "0"});
  const auto json = figures(command);
  EXPECT_EQ(json["poses"], 19);
  EXPECT_EQ(json["not_ok"], 11);
  EXPECT_EQ(json["unmatched"], 10);
  EXPECT_NEAR(json["nees_mean"], 1, 1e-6);
  EXPECT_EQ(json["longest_beyond_5_sigma_s"], 0);
  EXPECT_EQ(json["worst_beyond_5_sigma_m"], 0);
  const std::string text = run(command).out;
  for (const char* line :
       {"\nall              19    1.000", "\n11 poses that are not ok left out\n",
        "\n10 poses that the truth does not cover\n"})
    EXPECT_NE(text.find(line), std::string::npos) << text;
  writeCov("cov.csv", 40, 0.6, 5);
  EXPECT_NEAR(figures(command)["longest_beyond_5_sigma_s"], 29 - 13, 1e-9)
      << "12 is not ok, the truth ends with 29";
  EXPECT_NEAR(figures(command)["worst_beyond_5_sigma_m"], 0.6, 1e-9);
  writeWay("truth.tum", 30, 1, [](int i) { return i < 20 || i > 22; });
  EXPECT_NEAR(figures(command)["longest_beyond_5_sigma_s"], 29 - 23, 1e-9);
}

TEST_F(ConsistencyEval, AddsTheUncertaintyOfTheTruth) {
  writeCov("cov.csv", 30, 0.2, 0.2);
  const auto json = figures(with("cov.csv", {"--truth-sigma-m", "0.1", "--truth-sigma-deg", "1"}));
  EXPECT_NEAR(json["nees_mean"], 0.04 / 0.02, 1e-9);  // 4 without
  EXPECT_NEAR(json["truth_sigma_deg"], 1, 1e-12);
}

TEST_F(ConsistencyEval, RefusesWhatDoesNotFitTogether) {
  writeCov("cov.csv", 30, 0.1, 5);
  writeText(at("short.csv"), "scan,state\n0,ok\n");
  writeText(at("odd.csv"), "scan,state\n4,ok\n");
  writeText(at("flat.csv"), covHeader + "0,0,0,0,0,0,0,0,0,0,0\n");
  writeText(at("other.csv"), "scan,timestamp\n0,0\n");
  const std::string truth = at("truth.tum");
  expectRefusals({
      {with("cov.csv", {"--skip-metres", "1000"}), {"cov.csv", "no pose is left"}},
      {with("cov.csv", {"--truth", truth, truth}), {"3 truths", "1 runs"}},
      {with("cov.csv", {"--health", at("short.csv")}), {"short.csv", "no scan"}},
      {with("cov.csv", {"--health", at("odd.csv")}), {"odd.csv:2", "scan 0 expected"}},
      {with("cov.csv", {"--health", at("odd.csv"), at("odd.csv")}), {"2 health files"}},
      {with("flat.csv", {"--skip-metres", "0"}), {"flat.csv", "positive definite"}},
      {with("other.csv"), {"other.csv", "x_m"}},
  });
  expectUsageError(run(with("cov.csv", {"--truth-sigma-m", "-1"})));
  expectUsageError(run({"consistency", "--truth", truth}));
}

}  // namespace
}  // namespace polemcl::test_consistency_eval
