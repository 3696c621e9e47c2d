#include <gtest/gtest.h>

#include "config/Config.h"
#include "sim/common/SimulationOptions.h"

namespace polemcl::test_simulation_settings {

using namespace polemcl;
using namespace polemcl::sim;

TEST(SimulationSettings, WhatIsWrittenReadsBackTheSame) {
  SimulationOptions written;
  written.spacing = 0.31;
  written.motionDistortion = true;
  written.reverse = true;
  written.scans = 12;
  written.world.seed = 987654321;
  written.world.day = 4;
  written.world.track = "road.txt.gz";
  written.world.treeSpacing = 6.5;
  written.world.replacedPerYear = 0.1;
  written.world.dayOfYear = 135;
  written.world.buildingSites = 2.5;
  written.world.sideStreets = 2;
  written.detour = 2;
  ConfigWriter writer;
  bind(writer, written);
  ConfigReader reader(ConfigFile::fromText(writer.text(), "test"));
  SimulationOptions read;
  bind(reader, read);
  reader.finish();
  EXPECT_EQ(read.spacing, written.spacing);
  EXPECT_TRUE(read.motionDistortion);
  EXPECT_TRUE(read.reverse);
  EXPECT_EQ(read.scans, 12);
  EXPECT_EQ(read.world.seed, written.world.seed);
  EXPECT_EQ(read.world.day, 4);
  EXPECT_EQ(read.world.track, "road.txt.gz");
  EXPECT_EQ(read.world.treeSpacing, 6.5);
  EXPECT_EQ(read.world.replacedPerYear, 0.1);
  EXPECT_EQ(read.world.dayOfYear, 135);
  EXPECT_EQ(read.world.buildingSites, 2.5);
  EXPECT_EQ(read.world.sideStreets, 2);
  EXPECT_EQ(read.detour, 2);
}

TEST(SimulationSettings, RefusesWhatIsOutOfRangeWithFileSectionAndKey) {
  ConfigReader reader(ConfigFile::fromText("[world]\ntree_share = 1.2\n", "street.ini"));
  SimulationOptions options;
  try {
    bind(reader, options);
    FAIL() << "accepted";
  } catch (const Error& error) {
    const std::string message = error.what();
    for (const char* part : {"street.ini", "world", "tree_share", "1.2", "0 to 1"})
      EXPECT_NE(message.find(part), std::string::npos) << part << " in " << message;
  }
}

}  // namespace polemcl::test_simulation_settings
