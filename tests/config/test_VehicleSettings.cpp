#include <gtest/gtest.h>

#include "cli/Settings.h"
#include "config/Config.h"
#include "support/ExpectHas.h"
#include "support/Refusal.h"

namespace polemcl::test_vehicle_settings {
namespace {

using apps::AllSettings;

AllSettings load(const std::string& text) {
  return apps::settingsFrom(ConfigFile::fromText(text, "t.ini"), {});
}

const std::string kTwo =
    "[sensor]\nmodel = vlp16\nheight_m = 1.2\n[scan_line]\nmax_range_m = 30\n"
    "[vehicle]\nlidars = front os/rear.1\nfuse_within_s = 0.03\n"
    "[sensor:os/rear.1]\nmodel = hdl32e\npose = -1 0.2 1.5 180 5 0\nclock_offset_s = -0.02\n"
    "[scan_line:front]\nmin_top_m = 3\n[range_image:front]\nrows = 16\n";

TEST(VehicleSettings, ALidarHasWhatItsSectionsSayAndElseWhatAllHave) {
  const AllSettings all = load(kTwo);
  ASSERT_EQ(all.vehicle.lidars.size(), 2u);
  const LidarOptions &front = all.vehicle.lidars[0], &rear = all.vehicle.lidars[1];
  EXPECT_EQ(front.label, "front");
  EXPECT_EQ(front.sensor.model, "vlp16");
  EXPECT_EQ(front.sensor.height, 1.2);
  EXPECT_EQ(front.extraction.scanLine.maxRange, 30);
  EXPECT_EQ(front.extraction.scanLine.minTop, 3);
  EXPECT_EQ(front.extraction.rangeImage.rows, 16);
  EXPECT_TRUE(front.pose.empty());
  EXPECT_FALSE(front.extractor().sensorPose);
  EXPECT_EQ(rear.sensor.model, "hdl32e");
  EXPECT_EQ(rear.sensor.height, 1.2);
  EXPECT_EQ(rear.sensor.timing.clock, -0.02);
  EXPECT_EQ(rear.extraction.scanLine.minTop, ScanLineOptions().minTop);
  ASSERT_TRUE(rear.extractor().sensorPose);
  EXPECT_NEAR(rear.extractor().sensorPose->pitch(), 5 * M_PI / 180, 1e-12);
  EXPECT_EQ(all.reading().vehicle.fuseWithin, 0.03);
}

TEST(VehicleSettings, WrittenSettingsAreReadBackTheSame) {
  const AllSettings all = load(kTwo);
  const std::string text = apps::settingsText(all);
  EXPECT_HAS(text, "[sensor:os/rear.1]");
  EXPECT_HAS(text, "pose = -1 0.2 1.5 180 5 0");
  EXPECT_EQ(apps::settingsText(load(text)), text);
}

TEST(VehicleSettings, AssignmentsReachTheSectionsOfALidar) {
  const AllSettings all =
      apps::settingsFrom(ConfigFile::fromText(kTwo, "t.ini"), {"sensor:os/rear.1.height_m=2.5"});
  EXPECT_EQ(all.vehicle.lidars[1].sensor.height, 2.5);
  EXPECT_EQ(all.vehicle.lidars[0].sensor.height, 1.2);
}

TEST(VehicleSettings, Refusals) {
  EXPECT_REFUSED(load("[sensor:front]\nheight_m = 1\n"),
                 "[vehicle] lidars must list the label behind the colon");
  EXPECT_REFUSED(load("[vehicle]\nlidars = front Front\n"), "each label once");
  EXPECT_REFUSED(load("[vehicle]\nlidars = front re[ar\n"), "re[ar is not one");
  EXPECT_REFUSED(load("[vehicle]\nlidars = a\n[sensor:a]\npose = 1 2 3\n"),
                 "[sensor:a] pose = 3: allowed is six numbers");
  EXPECT_REFUSED(load("[vehicle]\nlidars = a\n[sensor:a]\nmodel = table\n"),
                 "[sensor:a] elevations_deg");
  std::string many = "[vehicle]\nlidars =";
  for (int i = 0; i < 65; ++i) many += " l" + std::to_string(i);
  EXPECT_REFUSED(load(many + '\n'), "[vehicle] lidars = 65: allowed is at most 64 labels");
  EXPECT_REFUSED(load("[vehicle]\nfuse_within_s = -1\n"), "[vehicle] fuse_within_s = -1");
}

}  // namespace
}  // namespace polemcl::test_vehicle_settings
