#include <gtest/gtest.h>

#include "sim/common/SimulationOptions.h"
#include "sim/lidar/LidarModel.h"
#include "support/Refusal.h"

namespace polemcl::test_simulation_options {

using namespace polemcl::sim;

TEST(SimulationOptions, DefaultsAreAllowed) {
  EXPECT_NO_THROW(SimulationOptions().validate());
  EXPECT_NO_THROW(WorldOptions().validate());
}

TEST(SimulationOptions, RefusesWhatItCannotSimulate) {
  SimulationOptions options;
  options.sensor = "lms200";
  EXPECT_REFUSED(makeLidar(options), "lms200");
  options = {};
  options.world.replacedPerYear = 1;
  EXPECT_REFUSED(options.validate(), "[world] replaced_per_year = 1", "allowed");
}

}  // namespace polemcl::test_simulation_options
