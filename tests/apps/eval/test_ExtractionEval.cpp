#include <mrpt/obs/CObservationPointCloud.h>

#include <nlohmann/json.hpp>

#include <polemcl/mrpt/observation/CObservationPoles.h>
#include "cli/RawlogActions.h"
#include "eval/EvalApp.h"
#include "eval/ExtractionEval.h"
#include "eval/MotionEval.h"
#include "extract/ExtractApp.h"
#include "mrpt/rawlog/RawlogWriter.h"
#include "support/StreetTest.h"

namespace polemcl::test_extraction_eval {

using namespace polemcl;
using namespace polemcl::apps;
using namespace testing_apps;

namespace {

PoleDetection detection(double x, double y, double confidence) {
  PoleDetection d;
  d.x = x;
  d.y = y;
  d.radius = 0.12;
  d.confidence = confidence;
  return d;
}

class ExtractionEval : public StreetTest {
 protected:
  Outcome run(const std::vector<std::string>& arguments) { return runProgram(evalMain, arguments); }
  nlohmann::json json(const std::string& name) const {
    return nlohmann::json::parse(readText(folder / name));
  }

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

  /// A rawlog of poles, all scans alike.
  void writePoles(const std::string& name, const std::vector<double>& times,
                  const std::vector<PoleDetection>& poles,
                  const mrpt::poses::CPose3D& sensorPose = {}) {
    RawlogWriter writer(at(name));
    for (const double time : times) {
      auto scan = std::make_shared<CObservationPoles>();
      scan->timestamp = mrpt::Clock::fromDouble(time);
      scan->sensorPose = sensorPose;
      scan->poles = poles;
      writer.write(makeActions(standstill(), scan->timestamp), scan);
    }
    writer.commit();
  }
};

}  // namespace

TEST_F(ExtractionEval, DetectionsAreScoredAgainstTheLabels) {
  writeLabelled("sim");
  // In the scans' frame pole 1 is at (10, 0), pole 2 at (0, 3): 3 cm beyond and 4 cm left of the
  // first, exactly at the second, which is not visible, and one where nothing is.
  writePoles("p.rawlog", {20.25, 21.25},
             {detection(10.03, 0.04, 0.9), detection(0, 3, 0.8), detection(-8, 1, 0.6)});
  const auto outcome = run({"detections", "--scans", at("sim"), "--poles", at("p.rawlog"), "--json",
                            at("s.json"), "--visible", at("v.csv")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("0.6667"), std::string::npos) << outcome.out;
  const auto score = json("s.json");
  EXPECT_EQ(score["scans"], 2);
  EXPECT_EQ(score["detections"], 6);
  EXPECT_EQ(score["right"], 4);
  EXPECT_EQ(score["visible"], 2);
  EXPECT_EQ(score["found"], 2);
  EXPECT_NEAR(score["precision"], 2.0 / 3, 1e-12);
  EXPECT_EQ(score["recall"], 1.0);
  EXPECT_NEAR(score["centre_mean_m"], 0.025, 1e-9);
  EXPECT_NEAR(score["bias_along_m"], 0.015, 1e-9);
  EXPECT_NEAR(score["bias_across_m"], 0.02, 1e-9);
  EXPECT_NEAR(score["radius_bias_m"], 0.02, 1e-9);
  EXPECT_NEAR(score["nees_mean"], 0.125, 1e-9);
  EXPECT_EQ(score["auc"], 1.0);
  EXPECT_EQ(readText(folder / "v.csv"),
            "id,x,y,radius,top,scans\n1,5.0000,10.0000,0.1000,4.0000,2\n");
}

TEST_F(ExtractionEval, ThePolesOfTheMapAreSeenFromWhateverFrameTheCloudHas) {
  writeLabelled("sim");
  // The cloud's frame upside down on the robot: its y axis points the other way, and up is down.
  std::string poses;
  for (int i = 0; i < 2; ++i) poses += "0 1 0 5 1 0 0 0 0 0 -1 2\n";
  writeText(folder / "sim/poses.txt", poses);
  writePoles("p.rawlog", {20.25}, {detection(10, 0.1, 0.9)},
             mrpt::poses::CPose3D(1, 2, 3, 0.7, 0, M_PI));
  EvalDetectionsOptions options;
  options.scans = folder / "sim";
  options.poles = folder / "p.rawlog";
  const auto score = evalDetections(options);
  EXPECT_EQ(score.found, 1u);
  EXPECT_NEAR(*score.biasAcross, 0.1, 1e-9);
  options.minScans = 2;  // of the one scan that has poles
  options.visible = folder / "v.csv";
  evalDetections(options);
  EXPECT_EQ(readText(folder / "v.csv"), "id,x,y,radius,top,scans\n");
}

TEST_F(ExtractionEval, RefusesScansThatDoNotBelongToThePoles) {
  writeLabelled("sim");
  writePoles("late.rawlog", {20.25, 22.25}, {});
  expectFailure(run({"detections", "--scans", at("sim"), "--poles", at("late.rawlog")}),
                {at("sim"), "22.25", "scan 1"});
  writePoles("p.rawlog", {20.25}, {});
  fs::remove(folder / "sim/labels/000000.label");
  expectFailure(run({"detections", "--scans", at("sim"), "--poles", at("p.rawlog")}),
                {"000000.label"});
  fs::remove(folder / "sim/poses.txt");
  expectFailure(run({"detections", "--scans", at("sim"), "--poles", at("p.rawlog")}),
                {"poses.txt"});
  fs::remove(folder / "sim/poles_gt.csv");
  expectFailure(run({"detections", "--scans", at("sim"), "--poles", at("p.rawlog")}),
                {"poles_gt.csv"});
  expectUsageError(run({"detections", "--scans", at("sim")}));
}

TEST_F(ExtractionEval, PolesOfAStreetAreFoundAgain) {
  writeStreet(folder / "street", 9);
  import("street");
  ExtractOptions options;
  options.input = folder / "street.rawlog";
  options.output = folder / "poles.rawlog";
  extractPoles(options, settings());
  const auto outcome = run({"repeatability", "--poles", at("poles.rawlog"), "--truth",
                            at("street.tum"), "--json", at("r.json")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto score = json("r.json");
  EXPECT_EQ(score["scans"], 9);
  EXPECT_GT(score["per_scan"], 5);
  EXPECT_GE(score["share"], 0.9);  // some leave the view
  // With poses that stand still they are not where they were.
  writeText(folder / "still.tum", "0 0 0 0 0 0 0 1\n");
  std::string still;
  for (int i = 0; i < 100; ++i) still += std::to_string(i) + " 0 0 0 0 0 0 1\n";
  writeText(folder / "still.tum", still);
  EvalRepeatabilityOptions wrong;
  wrong.poles = folder / "poles.rawlog";
  wrong.truth = folder / "still.tum";
  EXPECT_LT(evalRepeatability(wrong).share, 0.1);
}

TEST_F(ExtractionEval, RepeatabilityAndMotionKnowTheMotionWithinAScan) {
  // At 10 m/s, a pole is measured 0.05 s before or after the time of the scan: in turn.
  RawlogWriter writer(at("p.rawlog"));
  std::string rows;
  for (int i = 0; i < 10; ++i) {
    rows += std::to_string(i) + " " + std::to_string(10 * i) + " 0 0 0 0 0 1\n";
    auto scan = std::make_shared<CObservationPoles>();
    scan->timestamp = mrpt::Clock::fromDouble(i);
    for (const double x : {30., 55., 80.}) {
      const double offset = i % 2 == 0 ? 0.05 : -0.05;
      scan->poles.push_back(detection(x - 10 * (i + offset), 5, 0.9));
      scan->poles.back().timeOffset = offset;
    }
    writer.write(makeActions(standstill(), scan->timestamp), scan);
  }
  writer.commit();
  writeText(folder / "t.tum", rows);
  EvalRepeatabilityOptions options;
  options.poles = folder / "p.rawlog";
  options.truth = folder / "t.tum";
  EXPECT_EQ(evalRepeatability(options).share, 1);
  EvalMotionOptions motion;
  motion.poles = folder / "p.rawlog";
  motion.truth = folder / "t.tum";
  motion.every = 1;
  for (const MotionComparison& stretch : evalMotion(motion)) {
    EXPECT_EQ(stretch.poles.pairs, 3u);
    EXPECT_NEAR(stretch.poles.motion.x, 10, 1e-6);
  }
}

TEST_F(ExtractionEval, RepeatabilityRefusesWhatCannotBeCompared) {
  writePoles("p.rawlog", {1, 2, 3, 4, 5}, {});
  std::string rows;
  for (int i = 0; i < 5; ++i) rows += std::to_string(i) + " 0 0 0 0 0 0 1\n";
  writeText(folder / "t.tum", rows);
  expectFailure(run({"repeatability", "--poles", at("p.rawlog"), "--truth", at("t.tum")}),
                {at("t.tum"), "5.000000 s", "scan 4"});
  writeText(folder / "t.tum", rows + "5 0 0 0 0 0 0 1\n");
  expectFailure(run({"repeatability", "--poles", at("p.rawlog"), "--truth", at("t.tum")}),
                {at("p.rawlog"), "5 scans"});
  writeStreet(folder / "street", 2);
  import("street");
  expectFailure(run({"repeatability", "--poles", at("street.rawlog"), "--truth", at("street.tum")}),
                {"pole-extract"});
}

TEST_F(ExtractionEval, TurnedScansOfAStreetHaveTheSamePoles) {
  writeStreet(folder / "street", 3);
  import("street", false);
  const auto outcome = run({"rotation", "--config", config(), "--input", at("street.rawlog"),
                            "--every", "2", "--json", at("r.json")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto score = json("r.json");
  EXPECT_EQ(score["scans"], 2);
  EXPECT_EQ(score["turns"], 22);
  EXPECT_GT(score["poles"], 22 * 5);
  EXPECT_GE(score["share"], 0.98);
  EXPECT_GE(score["back_share"], 0.98);
  writePoles("p.rawlog", {1}, {});
  expectFailure(run({"rotation", "--config", config(), "--input", at("p.rawlog")}),
                {at("p.rawlog"), "only scans can be turned"});
  expectUsageError(
      run({"rotation", "--config", config(), "--input", at("p.rawlog"), "--every", "0"}));
  EvalRotationOptions none;
  none.input = folder / "street.rawlog";
  none.every = 0;
  EXPECT_THROW(evalRotation(none, settings()), Error);
}

}  // namespace polemcl::test_extraction_eval
