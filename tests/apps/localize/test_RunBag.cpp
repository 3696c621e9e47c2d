// `pole-localize --mcap`: the first run as a bag of ROS 2.

#include <gtest/gtest.h>

#include "core/common/Angles.h"
#include "io/rosbag/Bag.h"
#include "io/rosbag/Cdr.h"
#include "io/rosbag/RosMessages.h"
#include "support/LocalizeTest.h"

namespace polemcl::test_run_bag {
namespace {

using namespace testing_apps;

class RunBag : public LocalizeTest {
 protected:
  fs::path file() const { return folder / "run.mcap"; }
  std::vector<std::string> toBag() const { return {"--mcap", file().string()}; }
  /// The messages of a topic.
  std::vector<std::string> messages(const std::string& topic) const {
    const io::Bag bag(file());
    std::vector<std::string> all;
    for (std::size_t i = 0; i < bag.topics().size(); ++i)
      if (bag.topics()[i].name == topic)
        for (const auto& message : bag.messages(i)) all.push_back(bag.read(message));
    return all;
  }
};

TEST_F(RunBag, HoldsThePosesOfTheFirstRun) {
  ASSERT_EQ(runWithTruth(toBag()).code, 0);
  const auto poses = io::readPlanarTum(out("run_00.tum"));
  const auto transforms = messages("/tf"), stamped = messages("/pose");
  ASSERT_EQ(transforms.size(), scans);
  ASSERT_EQ(stamped.size(), scans);
  for (std::size_t i = 0; i < scans; ++i) {
    const auto link = io::decodeTransforms(transforms[i], "").at(0);
    EXPECT_EQ(link.header.frame, "map");
    EXPECT_EQ(link.child, "base_link");
    EXPECT_NEAR(link.header.time, poses[i].time, 1e-6);
    const auto& T = *link.T_parent_child;
    EXPECT_NEAR(T(0, 3), poses[i].pose.x, 1e-6);
    EXPECT_NEAR(T(1, 3), poses[i].pose.y, 1e-6);
    EXPECT_NEAR(wrapAngle(std::atan2(T(1, 0), T(0, 0)) - poses[i].pose.yaw), 0, 1e-6);
    io::CdrReader reader(stamped[i], "");
    EXPECT_NEAR(io::readHeader(reader).time, poses[i].time, 1e-6);
    EXPECT_NEAR(reader.get<double>(), poses[i].pose.x, 1e-6);
    EXPECT_NEAR(reader.get<double>(), poses[i].pose.y, 1e-6);
    for (int skipped = 0; skipped < 5; ++skipped) reader.get<double>();
    EXPECT_GT(reader.get<double>(), 0) << "variance of x";
  }
}

TEST_F(RunBag, HoldsPolesPathAndHealth) {
  ASSERT_EQ(runWithTruth(toBag()).code, 0);
  const auto map = messages("/map_poles"), poles = messages("/poles"), path = messages("/path");
  ASSERT_EQ(map.size(), 1u);
  EXPECT_EQ(io::CdrReader(map[0], "").getCount(1), street.map->poles().size() + 1);
  ASSERT_EQ(poles.size(), scans);
  for (std::size_t i = 0; i < scans; ++i)
    EXPECT_EQ(io::CdrReader(poles[i], "").getCount(1), street.frames[i].poles_robot.size() + 1);
  std::size_t length = 0, all = 0;
  for (const std::string& message : path) {
    io::CdrReader reader(message, "");
    io::readHeader(reader);
    EXPECT_GT(reader.getCount(1), 0u);
    length = message.size();
    all += length;
  }
  EXPECT_LE(all, 5 * length + 200 * path.size()) << "the bag does not grow with the square";
  const auto health = messages("/diagnostics");
  ASSERT_EQ(health.size(), scans);
  io::CdrReader reader(health.back(), "");
  io::readHeader(reader);
  EXPECT_EQ(reader.getCount(1), 1u);
  EXPECT_EQ(reader.get<std::uint8_t>(), 0) << "ok";
  EXPECT_EQ(reader.getText(), "pole-localize: pose");
  EXPECT_EQ(reader.getText(), "ok");
}

TEST_F(RunBag, HasNoPoseWhileItIsUnknown) {
  auto arguments = toBag();
  arguments.push_back("--global");
  ASSERT_EQ(run(arguments).code, 0);
  EXPECT_EQ(readText(out("run_00.tum")), "") << "the drive is too short to find it";
  for (const char* topic : {"/pose", "/tf", "/path"}) EXPECT_TRUE(messages(topic).empty());
  const auto health = messages("/diagnostics");
  ASSERT_EQ(health.size(), scans);
  io::CdrReader reader(health.front(), "");
  io::readHeader(reader);
  reader.getCount(1);
  EXPECT_EQ(reader.get<std::uint8_t>(), 2) << "lost";
}

TEST_F(RunBag, HasTheSameBytesAndChangesNoResult) {
  ASSERT_EQ(runWithTruth().code, 0);
  const std::string results = bytes();
  ASSERT_EQ(runWithTruth(toBag()).code, 0);
  EXPECT_EQ(bytes(), results);
  const std::string first = readText(file());
  ASSERT_EQ(runWithTruth({"--mcap", file().string(), "--threads", "1"}).code, 0);
  EXPECT_EQ(readText(file()), first);
}

TEST_F(RunBag, RefusesOtherNamesAndInputs) {
  EXPECT_EQ(runWithTruth({"--mcap", (folder / "run.bag").string()}).code, 2);
  EXPECT_HAS(runWithTruth({"--mcap", (folder / "run.bag").string()}).err, "must end in .mcap");
  expectFailure(runWithTruth({"--mcap", (folder / "none" / "run.mcap").string()}), {"run.mcap"});
}

TEST_F(RunBag, AppearsOnlyWithResults) {
  const std::vector<StampedPose2D> late{{1e6, {}}, {1e6 + 1, {}}};
  io::writeTum(folder / "late.tum", late);
  auto arguments = toBag();
  arguments.insert(arguments.end(), {"--truth", (folder / "late.tum").string()});
  expectFailure(run(arguments), {"the truth does not reach the first scan"});
  EXPECT_FALSE(fs::exists(file()));
}

}  // namespace
}  // namespace polemcl::test_run_bag
