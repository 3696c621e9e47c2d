#include "fuzz/Fuzz.h"
#include "io/dataset/Rosbag2.h"
#include "io/file/Bytes.h"
#include "io/rosbag/RosMessages.h"
#include "support/McapFiles.h"
#include "support/RosBags.h"

namespace polemcl::fuzz {
namespace {

void readMessage(std::string_view bytes) {
  static const Readers readers{[](auto rest) {
                                 io::TimingEstimate timing;
                                 timing.add(io::decodeCloud(rest, "cloud: ", true));
                                 timing.timing();
                                 timing.note();
                               },
                               [](auto rest) { io::decodeOdometry(rest, "odometry: "); },
                               [](auto rest) { io::decodeImu(rest, "imu: "); },
                               [](auto rest) { io::decodeNavSatFix(rest, "fix: "); },
                               [](auto rest) { io::decodeTransforms(rest, "transforms: "); }};
  readWithOne(readers, bytes);
}

tests::TestCloud smallCloud(double time, bool bigEndian = false) {
  tests::TestCloud cloud;
  cloud.time = time;
  cloud.bigEndian = bigEndian;
  cloud.fields.push_back({"time", 16, 7});
  cloud.pointBytes = 20;
  cloud.point(1, 2, 3, 4).put(0.01f);
  cloud.point(-5, 6, 0.5f, 9).put(0.02f);
  return cloud;
}

std::vector<std::string> messageSeeds() {
  return {inputFor(0, smallCloud(1.5).message()),
          inputFor(0, smallCloud(1.5, true).message()),
          inputFor(0, tests::turningCloud(1, -1, 0.5, 0, 0.1).message()),
          inputFor(1, tests::odometryMessage({1.5, 1, 2, 0.5})),
          inputFor(1, tests::odometryMessage({1.5, 1, 2, 0.5}, true)),
          inputFor(2, tests::imuMessage(1.5, "imu", {0, 0, 0.1}, 0.01)),
          inputFor(3, tests::fixMessage({1.5, 50.5, 7.25})),
          inputFor(4, tests::transformsMessage({{"base_link", "lidar", 1, 0, 2, 0.5}}))};
}

void readBag(const std::string& name, std::string_view bytes) {
  const auto bag = io::readRosbag2(fileOf(name, bytes), {{"", "", "/imu"}});
  for (const io::ScanEntry& scan : bag.scans) bag.read(scan);
}

/// Type, name and messages of the topics of a small recording.
struct Recorded {
  const char *topic, *type;
  std::vector<std::string> messages;
};
std::vector<Recorded> recording() {
  using namespace tests;
  return {{"/points", pointCloud2, {smallCloud(1).message(), smallCloud(1.1).message()}},
          {"/odom",
           odometry2,
           {odometryMessage({0.9}), odometryMessage({1.05, 0.5}), odometryMessage({1.2, 1})}},
          {"/imu", imu2, {imuMessage(1, "imu", {0, 0, 0.1}, 0.01)}},
          {"/fix", fix2, {fixMessage({1.05, 50.5, 7.25})}},
          {"/tf_static", transforms2, {transformsMessage({{"base_link", "lidar", 1, 0, 2, 0}})}}};
}

std::vector<std::string> sqliteSeeds() {
  const auto file = folder() / "seed.db3";
  {
    tests::TestBag bag(file);
    for (const Recorded& recorded : recording()) {
      const int topic = bag.topic(recorded.topic, recorded.type);
      for (const std::string& message : recorded.messages) bag.add(topic, 1000, message);
    }
  }
  return {io::readBytes(file)};
}

std::vector<std::string> mcapSeeds() {
  using namespace tests;
  std::string head, messages;
  std::uint16_t id = 0;
  for (const Recorded& recorded : recording()) {
    ++id;
    head += mcapSchema(id, recorded.type) + mcapChannel(id, id, recorded.topic);
    for (const std::string& message : recorded.messages) messages += mcapMessage(id, 1000, message);
  }
  return {mcapFile(head + messages), mcapFile(mcapChunk(head + messages, "zstd")),
          mcapFile(head + mcapChunk(messages, "lz4")), mcapFile(mcapChunk(head + messages)),
          mcapBegin(head + messages)};
}

}  // namespace

std::vector<Target> bagTargets() {
  return {{"ros_messages", readMessage, messageSeeds},
          {"bag_sqlite", [](auto bytes) { readBag("a.db3", bytes); }, sqliteSeeds},
          {"bag_mcap", [](auto bytes) { readBag("a.mcap", bytes); }, mcapSeeds}};
}

}  // namespace polemcl::fuzz
