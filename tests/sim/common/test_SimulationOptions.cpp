#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "core/common/Types.h"
#include "sim/common/SimulationOptions.h"
#include "sim/lidar/LidarModel.h"

namespace polemcl::test_simulation_options {

using namespace polemcl;
using namespace polemcl::sim;

namespace {
struct Refusal {
  const char* name;
  std::function<void(SimulationOptions&)> spoil;
  const char* message;  ///< what the message has to name
};

class SimulationOptionsRefusal : public testing::TestWithParam<Refusal> {};

std::string messageOf(const SimulationOptions& options) {
  try {
    options.validate();
    makeLidar(options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}
}  // namespace

TEST(SimulationOptions, defaultsAreAllowed) {
  EXPECT_NO_THROW(SimulationOptions().validate());
  EXPECT_NO_THROW(WorldOptions().validate());
}

TEST_P(SimulationOptionsRefusal, namesKeyAndLimits) {
  SimulationOptions options;
  GetParam().spoil(options);
  const std::string message = messageOf(options);
  EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
  EXPECT_NE(message.find("allowed"), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    SimulationOptions, SimulationOptionsRefusal,
    testing::Values(
        Refusal{"seed", [](auto& o) { o.world.seed = ~0ull; }, "[world] seed"},
        Refusal{"day", [](auto& o) { o.world.day = -1; }, "[world] day = -1"},
        Refusal{"length", [](auto& o) { o.world.length = 5; }, "[world] length_m = 5"},
        Refusal{"curviness", [](auto& o) { o.world.curviness = 3; }, "curviness"},
        Refusal{"relief", [](auto& o) { o.world.relief = -1; }, "relief"},
        Refusal{"roadWidth", [](auto& o) { o.world.roadWidth = 3; }, "road_width_m"},
        Refusal{"lampSpacing", [](auto& o) { o.world.lampSpacing = 0; }, "lamp_spacing_m"},
        Refusal{"signSpacing", [](auto& o) { o.world.signSpacing = 0; }, "sign_spacing_m"},
        Refusal{"treeSpacing", [](auto& o) { o.world.treeSpacing = 0; }, "tree_spacing_m"},
        Refusal{"treeShare", [](auto& o) { o.world.treeShare = 1.5; }, "tree_share"},
        Refusal{"parkedShare", [](auto& o) { o.world.parkedShare = -0.1; }, "parked_share"},
        Refusal{"clutter", [](auto& o) { o.world.clutter = 9; }, "clutter"},
        Refusal{"removedShare", [](auto& o) { o.world.removedShare = 2; }, "removed_share"},
        Refusal{"addedShare", [](auto& o) { o.world.addedShare = -1; }, "added_share"},
        Refusal{"foliage", [](auto& o) { o.world.foliage = 7; }, "foliage"},
        Refusal{"replaced", [](auto& o) { o.world.replacedPerYear = 1; }, "replaced_per_year = 1"},
        Refusal{"dayOfYear", [](auto& o) { o.world.dayOfYear = 366; }, "day_of_year = 366"},
        Refusal{"snowBank", [](auto& o) { o.world.snowBank = 5; }, "snow_bank_m"},
        Refusal{"buildingSites", [](auto& o) { o.world.buildingSites = -1; }, "building_sites"},
        Refusal{"sideStreets", [](auto& o) { o.world.sideStreets = 3; }, "side_streets = 3"},
        Refusal{"detour", [](auto& o) { o.detour = 1; }, "[simulation] detour = 1"},
        Refusal{"notANumber",
                [](auto& o) { o.world.relief = std::numeric_limits<double>::quiet_NaN(); },
                "relief"},
        Refusal{"sensor", [](auto& o) { o.sensor = "lms200"; }, "lms200"},
        Refusal{"height", [](auto& o) { o.height = 0; }, "height_m"},
        Refusal{"origin", [](auto& o) { o.originY = 99; }, "[sensor] origin = 99"},
        Refusal{"spacing", [](auto& o) { o.spacing = 0; }, "spacing_m"},
        Refusal{"speed", [](auto& o) { o.speed = 0; }, "speed_m_s"},
        Refusal{"odometryNoise", [](auto& o) { o.odometryNoise = -0.1; }, "odometry_noise"},
        Refusal{"scans", [](auto& o) { o.scans = -1; }, "scans"},
        // 10 m of road leave 3.8 m for the middle of a vehicle.
        Refusal{"lane", [](auto& o) { o.laneOffset = 4; }, "lane_offset_m = 4"}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace polemcl::test_simulation_options
