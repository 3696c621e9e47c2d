#include "extract/ExtractApp.h"
#include "support/EvalTest.h"

namespace polemcl::test_extraction_eval {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

class ExtractionEval : public EvalTest {
 protected:
  ExtractionEval() { writeLabelled("sim"); }

  /// Two scans at (5, 0) heading along y, in which the pole 1 at (5, 10) has eight returns over
  /// 1.4 m, the pole 2 at (2, 0) three and the pole 3 at (25, 0) none.
  void writeLabelled(const std::string& name) {
    Points points;
    std::string labels;
    const auto add = [&](float x, float y, float z, std::uint32_t label) {
      points.push_back({x, y, z, 0.5f});
      labels.append(reinterpret_cast<const char*>(&label), 4);
    };
    for (int i = 0; i < 8; ++i) add(9.9f, 0, 0.2f * static_cast<float>(i), 1);
    for (int i = 0; i < 3; ++i) add(0, 2.9f, 0.5f * static_cast<float>(i), 2);
    add(3, 3, -1, 0);
    const fs::path at = folder / name;
    std::string poses, times;
    for (std::size_t i = 0; i < 2; ++i) {
      writeBin(at / "velodyne" / scanName(i), points);
      writeText(at / "labels" / (scanName(i).substr(0, 6) + ".label"), labels);
      poses += poseRow(5, 0, M_PI / 2);
      times += std::to_string(20 + i) + ".25\n";
    }
    writeText(at / "poses.txt", poses);
    writeText(at / "times.txt", times);
    writeText(at / "poles_gt.csv",
              "id,x,y,radius,top,kind\n1,5,10,0.1,4,sign\n2,2,0,0.1,4,sign\n3,25,0,0.1,4,sign\n");
  }

  /// All scans alike.
  void writeAlike(const std::string& name, const std::vector<double>& times, const Poles& poles,
                  const mrpt::poses::CPose3D& sensorPose = {}) const {
    writePoles(
        name, times, [&](std::size_t) { return poles; }, standstill(), sensorPose);
  }
  Arguments detections(const std::string& poles) const {
    return {"detections", "--scans", at("sim"), "--poles", at(poles)};
  }
  Arguments repeatability(const std::string& poles, const std::string& truth) const {
    return {"repeatability", "--poles", at(poles), "--truth", at(truth)};
  }
};

TEST_F(ExtractionEval, DetectionsAreScoredAgainstTheLabels) {
  // In the scans' frame pole 1 is at (10, 0), pole 2 at (0, 3): 3 cm beyond and 4 cm left of the
  // first, exactly at the second, which is not visible, and one where nothing is.
  writeAlike("p.rawlog", {20.25, 21.25},
             {detection(10.03, 0.04, 0.9), detection(0, 3, 0.8), detection(-8, 1, 0.6)});
  Arguments command = detections("p.rawlog");
  command.insert(command.end(), {"--visible", at("v.csv")});
  const auto score = figures(command);
  const std::map<std::string, double> expected{{"scans", 2},
                                               {"detections", 6},
                                               {"right", 4},
                                               {"visible", 2},
                                               {"found", 2},
                                               {"precision", 2.0 / 3},
                                               {"recall", 1},
                                               {"centre_mean_m", 0.025},
                                               {"bias_along_m", 0.015},
                                               {"bias_across_m", 0.02},
                                               {"radius_bias_m", 0.02},
                                               {"nees_mean", 0.125},
                                               {"auc", 1}};
  for (const auto& [key, value] : expected) EXPECT_NEAR(score[key], value, 1e-9) << key;
  EXPECT_EQ(readText(at("v.csv")), "id,x,y,radius,top,scans\n1,5.0000,10.0000,0.1000,4.0000,2\n");
  const std::string text = run(command).out;
  EXPECT_HAS(text, "\nprecision 0.6667  recall 1.0000\ncentre error: median 2.5  mean 2.5  ");
}

TEST_F(ExtractionEval, ThePolesOfTheMapAreSeenFromWhateverFrameTheCloudHas) {
  // The cloud's frame upside down on the robot: its y axis points the other way, and up is down.
  std::string poses;
  for (int i = 0; i < 2; ++i) poses += "0 1 0 5 1 0 0 0 0 0 -1 2\n";
  writeText(at("sim/poses.txt"), poses);
  writeAlike("p.rawlog", {20.25}, {detection(10, 0.1, 0.9)},
             mrpt::poses::CPose3D(1, 2, 3, 0.7, 0, M_PI));
  Arguments command = detections("p.rawlog");
  const auto score = figures(command);
  EXPECT_EQ(score["found"], 1);
  EXPECT_NEAR(score["bias_across_m"], 0.1, 1e-9);
  // Two scans, of the one that has poles.
  command.insert(command.end(), {"--visible", at("v.csv"), "--min-scans", "2"});
  figures(command);
  EXPECT_EQ(readText(at("v.csv")), "id,x,y,radius,top,scans\n");
}

TEST_F(ExtractionEval, RefusesScansThatDoNotBelongToThePoles) {
  writeAlike("late.rawlog", {20.25, 22.25}, {});
  expectFailure(run(detections("late.rawlog")), {at("sim"), "22.25", "scan 1"});
  writeAlike("p.rawlog", {20.25}, {});
  for (const char* missing : {"labels/000000.label", "poses.txt", "poles_gt.csv"}) {
    fs::remove(at("sim") + '/' + missing);
    expectFailure(run(detections("p.rawlog")), {missing});
  }
  expectUsageError(run({"detections", "--scans", at("sim")}));
}

TEST_F(ExtractionEval, PolesOfAStreetAreFoundAgain) {
  importStreet("street", 9);
  ExtractOptions options;
  options.input = folder / "street.rawlog";
  options.output = folder / "poles.rawlog";
  extractPoles(options, settings());
  const auto score = figures(repeatability("poles.rawlog", "street.tum"));
  EXPECT_EQ(score["scans"], 9);
  EXPECT_GT(score["per_scan"], 5);
  EXPECT_GE(score["share"], 0.9);  // some leave the view
  writeWay("still.tum", 100, 0);   // then they are not where they were
  EXPECT_LT(figures(repeatability("poles.rawlog", "still.tum"))["share"], 0.1);
}

TEST_F(ExtractionEval, RepeatabilityAndMotionKnowTheMotionWithinAScan) {
  // At 10 m/s, a pole is measured 0.05 s before or after the time of the scan: in turn.
  writePoles("p.rawlog", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, [](std::size_t i) {
    const double offset = i % 2 == 0 ? 0.05 : -0.05;
    Poles poles;
    for (const double x : {30., 55., 80.}) {
      poles.push_back(detection(x - 10 * (static_cast<double>(i) + offset), 5));
      poles.back().timeOffset = offset;
    }
    return poles;
  });
  writeWay("t.tum", 10, 10);
  EXPECT_EQ(figures(repeatability("p.rawlog", "t.tum"))["share"], 1);
  const auto stretches =
      figures({"motion", "--poles", at("p.rawlog"), "--truth", at("t.tum"), "--every", "1"});
  EXPECT_EQ(stretches.size(), 9u);
  for (const auto& stretch : stretches) {
    EXPECT_EQ(stretch["pairs"], 3);
    EXPECT_NEAR(stretch["poles"]["m"], 10, 1e-6);
  }
}

TEST_F(ExtractionEval, RepeatabilityRefusesWhatCannotBeCompared) {
  writeAlike("p.rawlog", {1, 2, 3, 4, 5}, {});
  writeWay("short.tum", 5);
  writeWay("t.tum", 6);
  importStreet("street", 2);
  expectRefusals({
      {repeatability("p.rawlog", "short.tum"), {at("short.tum"), "5.000000 s", "scan 4"}},
      {repeatability("p.rawlog", "t.tum"), {at("p.rawlog"), "5 scans"}},
      {repeatability("street.rawlog", "street.tum"), {"pole-extract"}},
  });
}

TEST_F(ExtractionEval, TurnedScansOfAStreetHaveTheSamePoles) {
  writeStreet(folder / "street", 3);
  import("street", false);
  const auto rotation = [&](const std::string& input, const std::string& every) {
    return Arguments{"rotation", "--config", config(), "--input", at(input), "--every", every};
  };
  const auto score = figures(rotation("street.rawlog", "2"));
  EXPECT_EQ(score["scans"], 2);
  EXPECT_EQ(score["turns"], 22);
  EXPECT_GT(score["poles"], 22 * 5);
  EXPECT_GE(score["share"], 0.98);
  EXPECT_GE(score["back_share"], 0.98);
  writeAlike("p.rawlog", {1}, {});
  expectFailure(run(rotation("p.rawlog", "1")), {at("p.rawlog"), "only scans can be turned"});
  expectUsageError(run(rotation("p.rawlog", "0")));
}

}  // namespace
}  // namespace polemcl::test_extraction_eval
