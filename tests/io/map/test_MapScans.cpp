#include <random>

#include "core/mapping/MapAccumulator.h"
#include "io/map/MapScans.h"
#include "io/map/PoleMapFile.h"
#include "support/IoFiles.h"
#include "support/Poles.h"

namespace polemcl::test_map_scans {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;

class MapScans : public FolderTest {};

/// Random numbers; each must be kept to the last bit.
AddedSessions sample() {
  std::mt19937 random(7);
  const auto number = [&] { return static_cast<double>(random()) / 3e8 - 7; };
  AddedSessions added;
  added.unvisited = number();
  for (const char* name : {"one.rawlog", "", "zwei.rawlog"}) {
    AddedSession& session = added.sessions.emplace_back();
    session.name = name;
    for (int i = 0; i < 40 && !session.name.empty(); ++i) {
      const bool used = random() % 3 > 0;
      SessionScan scan;
      scan.time = 1e9 + number();
      scan.pose_map_robot = {number(), number(), number()};
      if (used) {
        scan.pose_robot_sensor = {number(), number(), number()};
        for (unsigned k = random() % 4; k > 0; --k) {
          PoleDetection pole{number(), number(), number(), number(), number(), number(), {}, 0};
          pole.covariance << number(), number(), number(), number();
          pole.points = static_cast<std::uint32_t>(random());
          scan.poles_robot.push_back(pole);
        }
        for (unsigned k = random() % 3 * 128; k > 0; --k)
          scan.visibilityRange.push_back(0.5f * static_cast<float>(random() % 100));
      }
      session.scans.push_back(scan);
      session.used.push_back(used);
    }
    for (std::size_t i = 0; i < session.scans.size() && session.name[0] == 'z'; ++i) {
      const Eigen::Matrix3d root = Eigen::Matrix3d::NullaryExpr(number);
      session.covariances.push_back((root * root.transpose()).selfadjointView<Eigen::Upper>());
    }
  }
  return added;
}

void expectSame(const Pose2D& a, const Pose2D& b) {
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.yaw, b.yaw);
}

void expectSame(const AddedSessions& a, const AddedSessions& b) {
  EXPECT_EQ(a.unvisited, b.unvisited);
  ASSERT_EQ(a.sessions.size(), b.sessions.size());
  for (std::size_t s = 0; s < a.sessions.size(); ++s) {
    const AddedSession &one = a.sessions[s], &two = b.sessions[s];
    EXPECT_EQ(one.name, two.name);
    EXPECT_EQ(one.used, two.used);
    EXPECT_EQ(one.covariances, two.covariances);
    ASSERT_EQ(one.scans.size(), two.scans.size());
    for (std::size_t i = 0; i < one.scans.size(); ++i) {
      EXPECT_EQ(one.scans[i].time, two.scans[i].time);
      expectSame(one.scans[i].pose_map_robot, two.scans[i].pose_map_robot);
      expectSame(one.scans[i].pose_robot_sensor, two.scans[i].pose_robot_sensor);
      EXPECT_EQ(one.scans[i].visibilityRange, two.scans[i].visibilityRange);
      ASSERT_EQ(one.scans[i].poles_robot.size(), two.scans[i].poles_robot.size());
      for (std::size_t k = 0; k < one.scans[i].poles_robot.size(); ++k)
        tests::expectSame(one.scans[i].poles_robot[k], two.scans[i].poles_robot[k]);
    }
  }
}

PoleMapData onePole() {
  PoleMapData data;
  MapPole pole;
  pole.x = 3;
  data.poles.push_back(pole);
  data.info["a"] = "b";
  return data;
}

TEST_F(MapScans, ComeBackToTheLastBit) {
  const AddedSessions before = sample();
  expectSame(unpackMapScans(packMapScans(before), "x: "), before);
  EXPECT_EQ(packMapScans(before), packMapScans(sample()));
}

TEST_F(MapScans, TravelInTheMapBesideItsPoles) {
  const fs::path with = path("with.polemap"), without = path("without.polemap");
  const AddedSessions scans = sample();
  writePoleMap(with, onePole(), &scans);
  writePoleMap(without, onePole());
  std::optional<AddedSessions> found;
  readPoleMap(without, &found);
  EXPECT_FALSE(found);
  const PoleMapData map = readPoleMap(with, &found);
  ASSERT_TRUE(found);
  expectSame(*found, scans);
  EXPECT_EQ(map.poles.size(), 1u);
  EXPECT_EQ(map.info, onePole().info);
}

TEST_F(MapScans, RefuseToBeDamaged) {
  const std::string good = packMapScans(sample());
  EXPECT_THROW(unpackMapScans("", "x: "), Error);
  for (std::size_t size = 0; size < good.size(); size += 97)
    EXPECT_THROW(unpackMapScans(good.substr(0, size), "x: "), Error) << size;
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    std::string bad = good;
    bad[random() % bad.size()] ^= static_cast<char>(1 + random() % 255);
    const std::string message = messageOf([&] { unpackMapScans(bad, "x: "); });
    EXPECT_EQ(message.rfind("x: ", 0), 0u) << message;  // by zlib's own checksum, or the size
  }
}

}  // namespace
}  // namespace polemcl::test_map_scans
