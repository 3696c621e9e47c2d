#include <cstdlib>
#include <nlohmann/json.hpp>

#include <polemcl/core/common/Types.h>
#include "eval/EvalApp.h"
#include "io/map/PoleMapFile.h"
#include "support/TempFolder.h"

namespace polemcl::test_eval_app {

using namespace polemcl;
using namespace polemcl::apps;
using namespace testing_apps;

namespace {

nlohmann::json readJson(const fs::path& file) {
  return nlohmann::json::parse(readText(file));
}

class EvalApp : public testing::Test {
 protected:
  /// Two map poles share the first true pole, the third is far from all; of three true poles the
  /// second is 0.8 m from none but its own.
  void writePoles() {
    writeText(folder / "truth.csv", "x,y\n0,0\n10,0\n20,0\n");
    writeText(folder / "map.csv", "x,y\n0.3,0\n0,0.9\n10,0.8\n15,5\n");
  }
  /// True poses on a line, 1 m and 1 s apart, heading along x.
  void writeTruth(int poses) {
    std::string rows = "# time x y z qx qy qz qw\n";
    for (int i = 0; i < poses; ++i)
      rows += std::to_string(i) + " " + std::to_string(i) + " 0 0 0 0 0 1\n";
    writeText(folder / "truth.tum", rows);
  }
  Outcome run(std::vector<std::string> arguments) { return runProgram(evalMain, arguments); }
  std::string at(const std::string& name) { return (folder / name).string(); }
  TempFolder folder;
};

}  // namespace

TEST_F(EvalApp, ScoresAMapTheAuthorsWay) {
  writePoles();
  const auto outcome =
      run({"map", "--truth", at("truth.csv"), "--map", at("map.csv"), "--json", at("score.json")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  // Three of four map poles lie within 1 m of a true pole: P = 3/4, R = 3/3.
  const auto json = readJson(folder / "score.json");
  EXPECT_EQ(json["matches"], 3);
  EXPECT_DOUBLE_EQ(json["precision"], 0.75);
  EXPECT_DOUBLE_EQ(json["recall"], 1.0);
  EXPECT_DOUBLE_EQ(json["f1"], 2 * 0.75 / 1.75);
  EXPECT_NE(outcome.out.find("0.7500"), std::string::npos) << outcome.out;
}

TEST_F(EvalApp, ScoresAMapOneToOneWithinARadius) {
  writePoles();
  EvalMapOptions options{folder / "truth.csv", folder / "map.csv", 1.0, true, std::nullopt};
  auto score = evalMap(options);
  EXPECT_EQ(score.matches, 2u);
  EXPECT_DOUBLE_EQ(score.precision, 0.5);
  EXPECT_DOUBLE_EQ(score.recall, 2.0 / 3);
  options.radius = 0.5;
  score = evalMap(options);
  EXPECT_EQ(score.matches, 1u);
}

TEST_F(EvalApp, PrintsThePublishedScores) {
  const char* data = std::getenv("POLEMCL_DATA");
  if (!data) GTEST_SKIP() << "POLEMCL_DATA is not set";
  const auto published = fs::path(data) / "published";
  const std::vector<std::string> arguments{"map", "--truth",
                                           (published / "nclt_truth.npz").string(), "--map",
                                           (published / "nclt_map_8_0.50_0.08.npz").string()};
  auto outcome = run(arguments);
  for (const char* figure : {"0.5254", "0.7129", "0.6049"})
    EXPECT_NE(outcome.out.find(figure), std::string::npos) << outcome.out;
  auto strict = arguments;
  strict.insert(strict.end(), {"--one-to-one", "--json", at("score.json")});
  outcome = run(strict);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto json = readJson(folder / "score.json");
  EXPECT_NEAR(json["precision"], 0.498, 5e-4);
  EXPECT_NEAR(json["recall"], 0.676, 5e-4);
  EXPECT_NEAR(json["f1"], 0.574, 5e-4);
}

TEST_F(EvalApp, TrajectoryFiguresAreThoseOfTheHand) {
  writeTruth(4);
  // Errors: 0.3 m ahead; 0.4 m left; 0.3 m ahead and 0.4 m right; the last beyond the truth.
  writeText(folder / "run.tum",
            "0 0.3 0 0 0 0 0 1\n"
            "1 1 0.4 0 0 0 0 1\n"
            "2 2.3 -0.4 0 0 0 0.08715574274765817 0.9961946980917455\n"  // 10 deg
            "9 9 0 0 0 0 0 1\n");
  const auto outcome = run({"trajectory", "--truth", at("truth.tum"), "--estimate", at("run.tum"),
                            "--json", at("errors.json")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto json = readJson(folder / "errors.json");
  EXPECT_EQ(json["poses"], 3);
  EXPECT_EQ(json["unmatched"], 1);
  EXPECT_NEAR(json["pos_mean"], (0.3 + 0.4 + 0.5) / 3, 1e-9);
  EXPECT_NEAR(json["pos_rmse"], std::sqrt((0.09 + 0.16 + 0.25) / 3), 1e-9);
  EXPECT_NEAR(json["pos_max"], 0.5, 1e-9);
  EXPECT_NEAR(json["lat_mean"], 0.8 / 3, 1e-9);
  EXPECT_NEAR(json["lon_mean"], 0.6 / 3, 1e-9);
  EXPECT_NEAR(json["ang_mean_deg"], 10.0 / 3, 1e-6);
  EXPECT_NEAR(json["ang_rmse_deg"], 10 / std::sqrt(3.0), 1e-6);
}

TEST_F(EvalApp, EvaluatesPerMetre) {
  writeTruth(4);
  std::string rows;
  for (int i = 0; i <= 30; ++i)  // ten poses a metre
    rows += std::to_string(0.1 * i) + " " + std::to_string(0.1 * i) + " 0.25 0 0 0 0 1\n";
  writeText(folder / "run.tum", rows);
  const auto outcome = run({"trajectory", "--truth", at("truth.tum"), "--estimate", at("run.tum"),
                            "--per", "metre", "--json", at("errors.json")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto json = readJson(folder / "errors.json");
  EXPECT_EQ(json["poses"], 4);
  EXPECT_EQ(json["per"], "metre");
  EXPECT_NEAR(json["pos_mean"], 0.25, 1e-9);
}

TEST_F(EvalApp, DrawsSceneAndPicture) {
  writeTruth(4);
  writeText(folder / "map.csv", "x,y\n1,2\n3,-2\n");
  const auto outcome =
      run({"trajectory", "--truth", at("truth.tum"), "--estimate", at("truth.tum"), "--map",
           at("map.csv"), "--scene", at("run.3Dscene"), "--png", at("run.png"), "--quiet"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(readText(folder / "run.png").substr(1, 3), "PNG");
  EXPECT_GT(fs::file_size(folder / "run.3Dscene"), 1000u);
}

TEST_F(EvalApp, ThePictureIsNamedAfterTheEstimateUnlessTold) {
  writeTruth(4);
  const auto draw = [&](const std::string& file, const std::vector<std::string>& title) {
    std::vector<std::string> line = {"trajectory",    "--truth", at("truth.tum"), "--estimate",
                                     at("truth.tum"), "--png",   at(file)};
    line.insert(line.end(), title.begin(), title.end());
    EXPECT_EQ(run(line).code, 0);
    return readText(folder / file);
  };
  const std::string named = draw("a.png", {});
  EXPECT_EQ(named, draw("b.png", {"--title", "truth.tum"}));
  EXPECT_NE(named, draw("c.png", {"--title", "Another street"}));
}

TEST_F(EvalApp, RefusesMissingAndEmptyFiles) {
  writePoles();
  expectFailure(run({"map", "--truth", at("none.csv"), "--map", at("map.csv")}), {"none.csv"});
  writeText(folder / "empty.csv", "x,y\n");
  expectFailure(run({"map", "--truth", at("truth.csv"), "--map", at("empty.csv")}),
                {"empty.csv", "no pole"});
  writeTruth(3);
  expectFailure(run({"trajectory", "--truth", at("truth.tum"), "--estimate", at("none.tum")}),
                {"none.tum"});
}

TEST_F(EvalApp, RefusesAnEstimateOfAnotherDrive) {
  writeTruth(4);
  writeText(folder / "run.tum", "1 0 0 0 0 0 0 1\n50 0 0 0 0 0 0 1\n51 0 0 0 0 0 0 1\n");
  writeText(folder / "errors.json", "old");
  expectFailure(run({"trajectory", "--truth", at("truth.tum"), "--estimate", at("run.tum"),
                     "--json", at("errors.json")}),
                {"run.tum", "truth.tum"});
  EXPECT_EQ(readText(folder / "errors.json"), "old");
}

TEST_F(EvalApp, RefusesARadiusThatIsNone) {
  writePoles();
  EvalMapOptions options{folder / "truth.csv", folder / "map.csv", 0, false, std::nullopt};
  EXPECT_THROW(evalMap(options), Error);
}

TEST_F(EvalApp, WrongUsage) {
  writePoles();
  expectUsageError(run({}));
  expectUsageError(run({"mop"}));
  expectUsageError(run({"map", "--truth", at("truth.csv")}));
  expectUsageError(
      run({"map", "--truth", at("truth.csv"), "--map", at("map.csv"), "--radius", "-1"}));
  expectUsageError(run({"trajectory", "--truth", "a", "--estimate", "b", "--per", "mile"}));
}

TEST_F(EvalApp, FailsWhenTheJsonCannotBeWritten) {
  writePoles();
  expectFailure(run({"map", "--truth", at("truth.csv"), "--map", at("map.csv"), "--json",
                     at("no/folder/score.json")}),
                {"no/folder"});
}

TEST_F(EvalApp, WritesTheTruthOfPfLocalization) {
  writeText(folder / "drive.tum",
            "0 1 2 0 0 0 0 1\n0.1 1.5 2 0 0 0 0 1\n0.2 2 2.5 0 0 0 0.7071067812 0.7071067812\n");
  const auto outcome =
      runProgram(evalMain, {"mrpt-truth", "--truth", (folder / "drive.tum").string(), "--output",
                            (folder / "truth.txt").string()});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(readText(folder / "truth.txt"),
            "0.100000000 1.500000000 2.000000000 0.000000000\n"
            "0.200000000 2.000000000 2.500000000 1.570796327\n");
  writeText(folder / "whole.tum", "0 1 2 0 0 0 0 1\n1 1.5 2 0 0 0 0 1\n");
  expectFailure(runProgram(evalMain, {"mrpt-truth", "--truth", (folder / "whole.tum").string(),
                                      "--output", (folder / "none.txt").string()}),
                {"whole.tum", "no whole seconds"});
}

}  // namespace polemcl::test_eval_app
