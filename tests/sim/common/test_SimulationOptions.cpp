#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include <polemcl/core/common/Types.h>
#include "sim/common/SimulationOptions.h"
#include "sim/lidar/LidarModel.h"

namespace polemcl::test_simulation_options {

using namespace polemcl;
using namespace polemcl::sim;

namespace {
struct RejectionReason {
  const char* name;
  std::function<void(SimulationOptions&)> spoil;
  const char* message;  ///< text that the message must contain
};

class SimulationOptionsRefusal : public testing::TestWithParam<RejectionReason> {};

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

TEST(SimulationOptions, DefaultsAreAllowed) {
  EXPECT_NO_THROW(SimulationOptions().validate());
  EXPECT_NO_THROW(WorldOptions().validate());
}

TEST_P(SimulationOptionsRefusal, NamesKeyAndLimits) {
  SimulationOptions options;
  GetParam().spoil(options);
  const std::string message = messageOf(options);
  EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
  EXPECT_NE(message.find("allowed"), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    SimulationOptions, SimulationOptionsRefusal,
    testing::Values(
        RejectionReason{"seed", [](auto& o) { o.world.seed = ~0ull; }, "[world] seed"},
        RejectionReason{"day", [](auto& o) { o.world.day = -1; }, "[world] day = -1"},
        RejectionReason{"length", [](auto& o) { o.world.length = 5; }, "[world] length_m = 5"},
        RejectionReason{"lampSpacing", [](auto& o) { o.world.lampSpacing = 0; }, "lamp_spacing_m"},
        RejectionReason{"signSpacing", [](auto& o) { o.world.signSpacing = 0; }, "sign_spacing_m"},
        RejectionReason{"treeSpacing", [](auto& o) { o.world.treeSpacing = 0; }, "tree_spacing_m"},
        RejectionReason{"treeShare", [](auto& o) { o.world.treeShare = 1.5; }, "tree_share"},
        RejectionReason{"removedShare", [](auto& o) { o.world.removedShare = 2; }, "removed_share"},
        RejectionReason{"addedShare", [](auto& o) { o.world.addedShare = -1; }, "added_share"},
        RejectionReason{"replaced", [](auto& o) { o.world.replacedPerYear = 1; },
                        "replaced_per_year = 1"},
        RejectionReason{"dayOfYear", [](auto& o) { o.world.dayOfYear = 366; }, "day_of_year = 366"},
        RejectionReason{"buildingSites", [](auto& o) { o.world.buildingSites = -1; },
                        "building_sites"},
        RejectionReason{"sideStreets", [](auto& o) { o.world.sideStreets = 3; },
                        "side_streets = 3"},
        RejectionReason{"detour", [](auto& o) { o.detour = 1; }, "[simulation] detour = 1"},
        RejectionReason{
            "notANumber",
            [](auto& o) { o.world.treeSpacing = std::numeric_limits<double>::quiet_NaN(); },
            "tree_spacing_m"},
        RejectionReason{"sensor", [](auto& o) { o.sensor = "lms200"; }, "lms200"},
        RejectionReason{"height", [](auto& o) { o.height = 0; }, "height_m"},
        RejectionReason{"origin", [](auto& o) { o.originY = 99; }, "[sensor] origin = 0 99 0"},
        RejectionReason{"spacing", [](auto& o) { o.spacing = 0; }, "spacing_m"},
        RejectionReason{"speed", [](auto& o) { o.speed = 0; }, "speed_m_s"},
        RejectionReason{"odometryNoise", [](auto& o) { o.odometryNoise = -0.1; }, "odometry_noise"},
        RejectionReason{"scans", [](auto& o) { o.scans = -1; }, "scans"}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace polemcl::test_simulation_options
