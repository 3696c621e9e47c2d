// Two LiDARs on one vehicle, from the configuration to the summary.

#include <gtest/gtest.h>

#include <cmath>

#include "cli/SensorCounts.h"
#include "support/LocalizeTest.h"

namespace testing_apps {
namespace {

class TwoLidars : public LocalizeTest {
 protected:
  /// Each LiDAR has a part of the poles, both have every third. Scan 7 of the rear one is missing.
  TwoLidars() {
    RawlogWriter writer((folder / "in.rawlog").string());
    std::size_t index = 0;
    for (const auto& frame : street.frames) {
      const auto front = CObservationPoles::Create(), rear = CObservationPoles::Create();
      rear->sensorPose = mrpt::poses::CPose3D(-1, 0, 0, M_PI, 0, 0);
      for (std::size_t i = 0; i < frame.poles_robot.size(); ++i) {
        PoleDetection pole = frame.poles_robot[i];
        if (i % 3 != 1) front->poles.push_back(pole);
        pole.x = -1 - pole.x;
        pole.y = -pole.y;
        if (i % 3 != 2) rear->poles.push_back(pole);
      }
      front->sensorLabel = "front";
      rear->sensorLabel = "rear";
      front->timestamp = rear->timestamp = mrpt::Clock::fromDouble(frame.time);
      front->points = rear->points = 500;
      writer.write(makeActions(frame.motion, front->timestamp), front);
      if (index++ != 7) writer.write(makeActions({}, rear->timestamp), rear);
    }
    writer.commit();
    writeText(folder / "config.ini",
              readText(folder / "config.ini") + "[vehicle]\nlidars = front rear\n");
  }
};

TEST_F(TwoLidars, ArePolesOfOneScan) {
  const Outcome outcome = succeeded(runWithTruth());
  const auto json = summary();
  EXPECT_EQ(json["scans"], scans);
  ASSERT_EQ(json["lidars"].size(), 2u);
  EXPECT_EQ(json["lidars"][0]["missing"], 0);
  EXPECT_EQ(json["lidars"][1]["label"], "rear");
  EXPECT_EQ(json["lidars"][1]["missing"], 1);
  EXPECT_GT(json["lidars"][1]["shared_poles"], 20);
  EXPECT_LT(json["lidars"][1]["apart_m"], 1e-6);
  EXPECT_HAS(outcome.out, "LiDAR rear: 39 scans, missing 1 times; ");
  EXPECT_EQ(outcome.out.find("disagrees"), std::string::npos);
  EXPECT_LT(json["pos_mean"], 0.2);
}

TEST(SensorCounts, SayThatLidarsDisagree) {
  SequenceCounts counts;
  counts.lidars.push_back({"rear", 39, 1, 2, 30, 0.35, 3.4});
  std::ostringstream text;
  printSensors(text, counts);
  EXPECT_HAS(text.str(),
             "LiDAR rear: 39 scans, missing 1 times, 2 dropped that came too late; 30 "
             "poles that others saw, 0.350 m apart (rms, 3.4 sigma)");
  EXPECT_HAS(text.str(),
             "LiDAR rear disagrees with the others: check pose and clock_offset_s in "
             "[sensor:rear]");
}

TEST(SensorCounts, SayThatScansLookRaw) {
  SequenceCounts counts;
  counts.untoldTurns["roof"] = {Turn::clockwise, M_PI / 2};
  const std::vector<std::string> doubts = turnDoubts(counts, {});
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_HAS(doubts[0], "scans of roof look raw");
  EXPECT_HAS(doubts[0],
             "begin up to 90 deg apart; set [sensor] turn = clockwise, moving_cut = true");
}

TEST_F(TwoLidars, WithoutNamesTheFirstIsUsedAndTheOtherIsNamed) {
  const Outcome outcome = succeeded(runWithTruth({"--set", "vehicle.lidars="}));
  EXPECT_HAS(outcome.out,
             "scans of other sensors, not used: 39 (polemcl::CObservationPoles rear); "
             "[vehicle] lidars lists the sensor labels to use");
}

}  // namespace
}  // namespace testing_apps
