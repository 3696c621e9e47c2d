#include <gtest/gtest.h>
#include <polemcl/sim/Drive.h>
#include <polemcl/sim/Scanner.h>

#include <map>

using namespace polemcl;
using namespace polemcl::sim;

TEST(Scanner, sameSeedGivesTheSameScan) {
  SimulationOptions options;
  options.world.length = 60;
  const World world = makeWorld(options.world);
  const Drive drive = makeDrive(world, options);
  const LidarModel lidar = makeLidar("vlp16");
  const SimulatedScan a = scan(world, drive.T_map_sensor[20], lidar, 5);
  const SimulatedScan b = scan(world, drive.T_map_sensor[20], lidar, 5);
  const SimulatedScan c = scan(world, drive.T_map_sensor[20], lidar, 6);
  EXPECT_GT(a.size(), 5000u);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.z, b.z);
  EXPECT_EQ(a.label, b.label);
  EXPECT_NE(a.x, c.x);
}
