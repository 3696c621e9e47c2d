#include <cstdlib>

#include "eval/Figures.h"
#include "io/map/PoleMapFile.h"
#include "support/EvalTest.h"

namespace polemcl::test_eval_app {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

class EvalApp : public EvalTest {
 protected:
  EvalApp() {
    // Two map poles share the first true pole, the third is far from all; of three true poles the
    // second is 0.8 m from none but its own.
    writeText(at("truth.csv"), "x,y\n0,0\n10,0\n20,0\n");
    writeText(at("map.csv"), "x,y\n0.3,0\n0,0.9\n10,0.8\n15,5\n");
    writeWay("truth.tum", 4);
  }
  Arguments map(const Arguments& more = {}) const {
    return command({"map", "--truth", at("truth.csv"), "--map", at("map.csv")}, more);
  }
  Arguments trajectory(const std::string& estimate, const Arguments& more = {}) const {
    return command({"trajectory", "--truth", at("truth.tum"), "--estimate", at(estimate)}, more);
  }

 private:
  static Arguments command(Arguments arguments, const Arguments& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
};

TEST(FiguresText, IsFilledIn) {
  const Json json{{"a", 1.25}, {"n", 7}, {"none", nullptr}, {"word", "slip"}, {"list", {1, 2}}};
  EXPECT_EQ(filled("{word} {n} of {n:2}, {a:1*100} cm|{a:8.3}|{none:6.1}|{none}: {list}", json),
            "slip 7 of 7.00, 125.0 cm|   1.250|     -|-: [1,2]");
  EXPECT_EQ(filled("", json), "");
}

TEST_F(EvalApp, ScoresAMapTheAuthorsWay) {
  // Three of four map poles lie within 1 m of a true pole: P = 3/4, R = 3/3.
  const auto json = figures(map());
  EXPECT_EQ(json["matches"], 3);
  EXPECT_DOUBLE_EQ(json["precision"], 0.75);
  EXPECT_DOUBLE_EQ(json["recall"], 1.0);
  EXPECT_DOUBLE_EQ(json["f1"], 2 * 0.75 / 1.75);
  EXPECT_EQ(run(map()).out,
            "map poles 4, truth poles 3, matches 3\nprecision 0.7500  recall 1.0000  F1 0.8571\n");
}

TEST_F(EvalApp, MapsOfDifferentDatumsAreNotCompared) {
  const auto mapAt = [&](const std::string& name, const std::string& datum) {
    io::PoleMapData data;
    data.poles.resize(1);
    data.info["datum"] = datum;
    io::writePoleMap(at(name), data);
    return at(name);
  };
  const auto one = mapAt("one.polemap", "52.5,13.4,0"), other = mapAt("other.polemap", "10,20,0");
  expectFailure(run({"map", "--truth", one, "--map", other}),
                {"other.polemap: its datum is 10,20,0", "one.polemap is 52.5,13.4,0"});
  EXPECT_EQ(run({"map", "--truth", one, "--map", one}).code, 0);
}

TEST_F(EvalApp, ScoresAMapOneToOneWithinARadius) {
  const auto json = figures(map({"--one-to-one"}));
  EXPECT_EQ(json["matches"], 2);
  EXPECT_DOUBLE_EQ(json["precision"], 0.5);
  EXPECT_DOUBLE_EQ(json["recall"], 2.0 / 3);
  EXPECT_EQ(figures(map({"--one-to-one", "--radius", "0.5"}))["matches"], 1);
}

TEST_F(EvalApp, PrintsThePublishedScores) {
  POLEMCL_NEEDS_DATA();
  const auto published = dataFolder() / "published";
  Arguments arguments{"map", "--truth", (published / "nclt_truth.npz").string(), "--map",
                      (published / "nclt_map_8_0.50_0.08.npz").string()};
  const auto outcome = run(arguments);
  for (const char* figure : {"0.5254", "0.7129", "0.6049"})
    EXPECT_NE(outcome.out.find(figure), std::string::npos) << outcome.out;
  arguments.push_back("--one-to-one");
  const auto json = figures(arguments);
  EXPECT_NEAR(json["precision"], 0.498, 5e-4);
  EXPECT_NEAR(json["recall"], 0.676, 5e-4);
  EXPECT_NEAR(json["f1"], 0.574, 5e-4);
}

TEST_F(EvalApp, TrajectoryFiguresAreThoseOfTheHand) {
  // Errors: 0.3 m ahead; 0.4 m left; 0.3 m ahead and 0.4 m right; the last beyond the truth.
  writeText(at("run.tum"),
            "0 0.3 0 0 0 0 0 1\n"
            "1 1 0.4 0 0 0 0 1\n"
            "2 2.3 -0.4 0 0 0 0.08715574274765817 0.9961946980917455\n"  // 10 deg
            "9 9 0 0 0 0 0 1\n");
  const auto json = figures(trajectory("run.tum"));
  EXPECT_EQ(json["poses"], 3);
  EXPECT_EQ(json["unmatched"], 1);
  EXPECT_NEAR(json["pos_mean"], (0.3 + 0.4 + 0.5) / 3, 1e-9);
  EXPECT_NEAR(json["pos_rmse"], std::sqrt((0.09 + 0.16 + 0.25) / 3), 1e-9);
  EXPECT_NEAR(json["pos_max"], 0.5, 1e-9);
  EXPECT_NEAR(json["lat_mean"], 0.8 / 3, 1e-9);
  EXPECT_NEAR(json["lon_mean"], 0.6 / 3, 1e-9);
  EXPECT_NEAR(json["ang_mean_deg"], 10.0 / 3, 1e-6);
  EXPECT_NEAR(json["ang_rmse_deg"], 10 / std::sqrt(3.0), 1e-6);
  EXPECT_EQ(json["per"], "pose");
}

TEST_F(EvalApp, EvaluatesPerMetre) {
  std::string rows;
  for (int i = 0; i <= 30; ++i)  // ten poses a metre
    rows += std::to_string(0.1 * i) + " " + std::to_string(0.1 * i) + " 0.25 0 0 0 0 1\n";
  writeText(at("run.tum"), rows);
  const auto json = figures(trajectory("run.tum", {"--per", "metre"}));
  EXPECT_EQ(json["poses"], 4);
  EXPECT_EQ(json["per"], "metre");
  EXPECT_NEAR(json["pos_mean"], 0.25, 1e-9);
}

TEST_F(EvalApp, DrawsSceneAndPicture) {
  const Outcome outcome =
      succeeded(run(trajectory("truth.tum", {"--map", at("map.csv"), "--scene", at("run.3Dscene"),
                                             "--png", at("run.png"), "--quiet"})));
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(readText(at("run.png")).substr(1, 3), "PNG");
  EXPECT_GT(fs::file_size(at("run.3Dscene")), 1000u);
}

TEST_F(EvalApp, ThePictureIsNamedAfterTheEstimateUnlessTold) {
  const auto draw = [&](Arguments title) {
    title.insert(title.end(), {"--png", at("a.png")});
    EXPECT_EQ(run(trajectory("truth.tum", title)).code, 0);
    return readText(at("a.png"));
  };
  const std::string named = draw({});
  EXPECT_EQ(named, draw({"--title", "truth.tum"}));
  EXPECT_NE(named, draw({"--title", "Another street"}));
}

TEST_F(EvalApp, WithoutMatplotlibAPictureIsRefusedInOneLineAndTheEarlierOneStays) {
  writeText(at("run.png"), "earlier");
  writeText(at("python/matplotlib.py"), "raise ImportError('No Matplotlib here')\n");
  ::setenv("PYTHONPATH", at("python").c_str(), 1);
  const auto before = names(fs::path(at("run.png")).parent_path());
  const auto outcome = run(trajectory("truth.tum", {"--png", at("run.png")}));
  ::unsetenv("PYTHONPATH");
  expectFailure(outcome,
                {"run.png: the picture could not be drawn: No Matplotlib here; install the "
                 "package python3-matplotlib"});
  EXPECT_EQ(readText(at("run.png")), "earlier");
  EXPECT_EQ(names(fs::path(at("run.png")).parent_path()), before) << "nothing is left behind";
}

TEST_F(EvalApp, RefusesWhatCannotBeScored) {
  writeText(at("empty.csv"), "x,y\n");
  writeText(at("other.tum"), "1 0 0 0 0 0 0 1\n50 0 0 0 0 0 0 1\n51 0 0 0 0 0 0 1\n");
  writeText(at("errors.json"), "old");
  expectRefusals({
      {{"map", "--truth", at("none.csv"), "--map", at("map.csv")}, {"none.csv"}},
      {{"map", "--truth", at("truth.csv"), "--map", at("empty.csv")}, {"empty.csv", "no pole"}},
      {map({"--json", at("no/folder/score.json")}), {"no/folder"}},
      {trajectory("none.tum"), {"none.tum"}},
      {trajectory("other.tum", {"--json", at("errors.json")}), {"other.tum", "truth.tum"}},
  });
  EXPECT_EQ(readText(at("errors.json")), "old");
}

TEST_F(EvalApp, WrongUsage) {
  for (const Arguments& wrong :
       {Arguments{}, Arguments{"mop"}, Arguments{"map", "--truth", at("truth.csv")},
        map({"--radius", "-1"}), map({"--radius", "0"}), trajectory("b", {"--per", "mile"})})
    expectUsageError(run(wrong));
}

}  // namespace
}  // namespace polemcl::test_eval_app
