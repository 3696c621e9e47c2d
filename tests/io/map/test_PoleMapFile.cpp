#include <zlib.h>

#include <array>
#include <limits>
#include <random>

#include "core/mapping/MapAccumulator.h"
#include "io/file/Bytes.h"
#include "io/map/PoleMapFile.h"
#include "support/IoFiles.h"
#include "support/Poles.h"

namespace polemcl::test_pole_map_file {
namespace {

using namespace polemcl::tests;
using namespace polemcl::io;
using namespace polemcl::io::test;

constexpr std::size_t kHeaderBytes = 24;

/// A whole file around a payload, with its checksum.
std::string wrapped(const std::string& payload, std::uint32_t version = 1) {
  ByteWriter writer;
  writer.putRaw(std::string_view("\x89PMAP\r\n\x1a", 8));
  writer.put(version);
  writer.put(static_cast<std::uint64_t>(payload.size()));
  writer.put(static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(payload.data()), static_cast<uInt>(payload.size()))));
  return writer.bytes() + payload;
}

std::string chunk(const std::string& tag, const std::string& content) {
  ByteWriter writer;
  writer.putRaw(tag);
  writer.put(static_cast<std::uint64_t>(content.size()));
  return writer.bytes() + content;
}

/// A POLE chunk of one record with `extra` bytes that are unknown to this version.
std::string poleChunk(const std::string& fields, std::uint64_t count, const std::string& extra) {
  ByteWriter writer;
  writer.put(static_cast<std::uint32_t>(76 + extra.size()));
  writer.put(count);
  return chunk("POLE", writer.bytes() + fields + std::string("\x11\0\0\0", 4) + extra);
}

const std::string kFieldsByHand = doubles({1, 2, 0.125, 0.25, 4.5, 0.75, 0.04, 0.01, 0.09});

class PoleMapFileTest : public FolderTest {
 protected:
  std::string refusal(const std::string& bytes) const {
    const fs::path file = write("m.polemap", bytes);
    return messageOf([&] { readPoleMap(file); });
  }
  std::string writeRefusal(const MapPole& bad) const {
    PoleMapData data;
    data.poles = {variedMapPole(0, 0), bad};
    return messageOf([&] { writePoleMap(path("m.polemap"), data); });
  }
};

TEST_F(PoleMapFileTest, ComesBack) {
  PoleMapData data;
  for (int i = 0; i < 100; ++i) data.poles.push_back(variedMapPole(0.1 * i - 3, 1e6 / (i + 1.0)));
  data.info = {
      {"config", "[map]\nmin_count = 3\n"}, {"empty", ""}, {"käse", std::string("a\0b", 3)}};
  writePoleMap(path("m.polemap"), data);
  const PoleMapData back = readPoleMap(path("m.polemap"));
  EXPECT_EQ(back.info, data.info);
  ASSERT_EQ(back.poles.size(), data.poles.size());
  for (std::size_t i = 0; i < data.poles.size(); ++i) expectSame(back.poles[i], data.poles[i]);
}

TEST_F(PoleMapFileTest, ASemidefiniteCovarianceComesBack) {
  PoleMapData data;
  data.poles = {variedMapPole(1, 2), variedMapPole(3, 4)};
  data.poles[0].covariance << 0.01, 0.01, 0.01, 0.01;
  data.poles[1].covariance.setZero();
  writePoleMap(path("m.polemap"), data);
  const PoleMapData back = readPoleMap(path("m.polemap"));
  for (std::size_t i = 0; i < 2; ++i) expectSame(back.poles.at(i), data.poles[i]);
}

TEST_F(PoleMapFileTest, AnEmptyMapComesBackEmpty) {
  writePoleMap(path("m.polemap"), {});
  const PoleMapData back = readPoleMap(path("m.polemap"));
  EXPECT_TRUE(back.poles.empty());
  EXPECT_TRUE(back.info.empty());
}

TEST_F(PoleMapFileTest, BytesByHand) {
  PoleMapData data;
  data.poles = {variedMapPole(1, 2)};
  data.info = {{"k", "vw"}};
  writePoleMap(path("m.polemap"), data);
  const std::string info = std::string("\1\0\0\0\1\0\0\0k\2\0\0\0vw", 15);
  EXPECT_EQ(read(path("m.polemap")),
            wrapped(chunk("INFO", info) + poleChunk(kFieldsByHand, 1, "")));
}

TEST_F(PoleMapFileTest, ReadsWhatLaterVersionsAppend) {
  const fs::path file = write(
      "m.polemap", wrapped(chunk("NEWS", "unknown") + poleChunk(kFieldsByHand, 1, "later field")));
  const PoleMapData data = readPoleMap(file);
  ASSERT_EQ(data.poles.size(), 1u);
  expectSame(data.poles[0], variedMapPole(1, 2));
}

TEST_F(PoleMapFileTest, HistoriesAndCandidatesComeBack) {
  PoleMapData data;
  data.poles = {variedMapPole(1, 2), variedMapPole(3, 4)};
  data.histories = {{7, 3, 0.875, 1.3e9, 1.4e9}, {0, 0, 0.5, 0, 0}};
  data.candidates = {{variedMapPole(5, 6), {2, 1, 0.25, 1.35e9, 1.35e9}, false}};
  writePoleMap(path("m.polemap"), data);
  const PoleMapData back = readPoleMap(path("m.polemap"));
  ASSERT_EQ(back.poles.size(), 2u);
  expectSame(back.poles[1], variedMapPole(3, 4));
  ASSERT_EQ(back.histories.size(), 2u);
  EXPECT_EQ(back.histories[0].seen, 7u);
  EXPECT_EQ(back.histories[0].missed, 3u);
  EXPECT_EQ(back.histories[0].existence, 0.875);
  EXPECT_EQ(back.histories[0].firstSeen, 1.3e9);
  EXPECT_EQ(back.histories[0].lastSeen, 1.4e9);
  ASSERT_EQ(back.candidates.size(), 1u);
  expectSame(back.candidates[0].pole, variedMapPole(5, 6));
  EXPECT_EQ(back.candidates[0].history.existence, 0.25);
  EXPECT_FALSE(back.candidates[0].present);
}

TEST_F(PoleMapFileTest, HistoryByHand) {
  PoleMapData data;
  data.poles = {variedMapPole(1, 2)};
  data.histories = {{7, 3, 0.875, 1.3e9, 1.4e9}};
  writePoleMap(path("m.polemap"), data);
  // Behind the fields that older programs know: they read 108 bytes per record and skip 32.
  const std::string info("\0\0\0\0", 4);
  const std::string history = doubles({0.875, 1.3e9, 1.4e9}) + std::string("\7\0\0\0\3\0\0\0", 8);
  EXPECT_EQ(read(path("m.polemap")),
            wrapped(chunk("INFO", info) + poleChunk(kFieldsByHand, 1, history)));
}

TEST_F(PoleMapFileTest, KeptMapsGoThereAndBack) {
  PoleMapData data;
  data.poles = {variedMapPole(1, 2)};
  data.histories = {{7, 3, 0.875, 1.3e9, 1.4e9}};
  data.candidates = {{variedMapPole(5, 6), {2, 1, 0.25, 1.35e9, 1.35e9}, false}};
  const LandmarkMap map = landmarkMap(data);
  ASSERT_EQ(map.poles.size(), 2u);
  EXPECT_TRUE(map.poles[0].present);
  EXPECT_FALSE(map.poles[1].present);
  const PoleMapData back = mapData(map, {{"k", "v"}});
  EXPECT_EQ(back.info.at("k"), "v");
  ASSERT_EQ(back.poles.size(), 1u);
  expectSame(back.poles[0], data.poles[0]);
  EXPECT_EQ(back.histories[0].seen, 7u);
  ASSERT_EQ(back.candidates.size(), 1u);
  expectSame(back.candidates[0].pole, data.candidates[0].pole);
  // A map of an earlier version: its count is used as the number of times seen.
  data.histories.clear();
  data.candidates.clear();
  const LandmarkMap old = landmarkMap(data);
  ASSERT_EQ(old.poles.size(), 1u);
  EXPECT_TRUE(old.poles[0].present);
  EXPECT_EQ(old.poles[0].history.seen, 17u);
}

TEST_F(PoleMapFileTest, RefusesHistoriesThatCannotBe) {
  PoleMapData data;
  data.poles = {variedMapPole(0, 0)};
  data.histories = {{}, {}};
  const auto refused = [&] { return messageOf([&] { writePoleMap(path("m.polemap"), data); }); };
  expectIn(refused(), "2 histories for 1 poles");
  data.histories = {{1, 1, 1.5, 0, 0}};
  expectIn(refused(), "pole 0", "existence");
  data.histories = {{1, 1, 0.5, -1, 0}};
  expectIn(refused(), "pole 0", "date");
  data.histories.clear();
  data.candidates = {{variedMapPole(0, 0), {}, false}};
  data.candidates[0].pole.radius = -1;
  expectIn(refused(), "candidate 0", "radius");
  EXPECT_FALSE(fs::exists(path("m.polemap")));
}

TEST_F(PoleMapFileTest, RefusesBadInput) {
  EXPECT_REFUSED(readPoleMap(path("no.polemap")), path("no.polemap").string(),
                 "No such file or directory");
  expectIn(refusal("x,y\n1,2\n"), path("m.polemap").string(), "not a pole map",
           "`pole-map convert`");
  expectIn(refusal(""), "not a pole map");
  expectIn(refusal(wrapped(poleChunk(kFieldsByHand, 1, ""), 2)), "version 2", "reads 1");
  expectIn(refusal(wrapped(poleChunk(kFieldsByHand, 1, "")) + "x"), "expected");
}

TEST_F(PoleMapFileTest, RefusesAWrongChecksum) {
  std::string bytes = wrapped(poleChunk(kFieldsByHand, 1, ""));
  bytes.back() ^= 1;
  expectIn(refusal(bytes), "CRC-32");
}

// The following files have damaged content and valid checksums, as from a faulty writer.

TEST_F(PoleMapFileTest, RefusesMorePolesThanThereIsRoomFor) {
  expectIn(refusal(wrapped(poleChunk(kFieldsByHand, 2, ""))), "2 poles of 76 bytes");
  expectIn(
      refusal(wrapped(poleChunk(kFieldsByHand, std::numeric_limits<std::uint64_t>::max(), ""))),
      "do not fit");
}

TEST_F(PoleMapFileTest, RefusesRecordsThatAreTooShort) {
  ByteWriter writer;
  writer.put(std::uint32_t{75});
  writer.put(std::uint64_t{1});
  writer.putRaw(std::string(75, '\0'));
  expectIn(refusal(wrapped(chunk("POLE", writer.bytes()))), "75 bytes");
}

TEST_F(PoleMapFileTest, RefusesAFileWithoutPoleList) {
  expectIn(refusal(wrapped(chunk("NEWS", "unknown"))), "no list of poles");
}

TEST_F(PoleMapFileTest, RefusesAChunkBeyondTheEnd) {
  std::string payload = poleChunk(kFieldsByHand, 1, "");
  payload[4] = static_cast<char>(payload[4] + 1);
  expectIn(refusal(wrapped(payload)), "mid-value");
}

TEST_F(PoleMapFileTest, RefusesInfoBeyondItsChunk) {
  const std::string info("\1\0\0\0\xff\xff\0\0k", 9);
  expectIn(refusal(wrapped(chunk("INFO", info) + poleChunk(kFieldsByHand, 1, ""))), "mid-value");
}

TEST_F(PoleMapFileTest, RefusesStoredPolesThatAreUnsound) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string fields = doubles({1, nan, 0.125, 0.25, 4.5, 0.75, 0.04, 0.01, 0.09});
  expectIn(refusal(wrapped(poleChunk(fields, 1, ""))), path("m.polemap").string(), "pole 0",
           "not finite");
}

TEST_F(PoleMapFileTest, RefusesToWriteValuesThatAreNotFinite) {
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(),
                        std::numeric_limits<double>::infinity()};
  for (double MapPole::*field : {&MapPole::x, &MapPole::y, &MapPole::radius, &MapPole::bottom,
                                 &MapPole::top, &MapPole::confidence}) {
    for (const double value : bad) {
      MapPole p = variedMapPole(0, 0);
      p.*field = value;
      expectIn(writeRefusal(p), path("m.polemap").string(), "pole 1", "not finite");
    }
  }
  MapPole p = variedMapPole(0, 0);
  p.covariance(1, 1) = bad[0];
  expectIn(writeRefusal(p), "covariance is not finite");
  EXPECT_TRUE(fs::is_empty(m_folder));
}

TEST_F(PoleMapFileTest, RefusesToWriteANegativeRadius) {
  MapPole p = variedMapPole(0, 0);
  p.radius = -0.1;
  expectIn(writeRefusal(p), "pole 1", "radius");
}

TEST_F(PoleMapFileTest, RefusesMoreBadInput) {
  for (const double confidence : {-0.1, 1.1}) {
    MapPole p = variedMapPole(0, 0);
    p.confidence = confidence;
    expectIn(writeRefusal(p), "pole 1", "confidence");
  }
  for (const auto& [xx, xy, yx, yy] : std::vector<std::array<double, 4>>{
           {0.01, 0.02, 0.02, 0.01}, {-0.01, 0, 0, -0.01}, {0.01, 1e-3, 0, 0.01}}) {
    MapPole p = variedMapPole(0, 0);
    p.covariance << xx, xy, yx, yy;
    expectIn(writeRefusal(p), "pole 1", "positive semidefinite");
  }
  MapPole p = variedMapPole(0, 0);
  p.covariance = 1.7e308 * Eigen::Matrix2d::Identity();
  expectIn(writeRefusal(p), "pole 1", "the covariance is above 1e12");
}

TEST_F(PoleMapFileTest, RefusesEveryPrefixOfAFile) {
  PoleMapData data;
  data.poles = {variedMapPole(1, 2), variedMapPole(3, 4)};
  data.info = {{"key", "value"}};
  writePoleMap(path("whole.polemap"), data);
  const std::string bytes = read(path("whole.polemap"));
  ASSERT_GT(bytes.size(), kHeaderBytes);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const fs::path file = write("m.polemap", bytes.substr(0, size));
    EXPECT_THROW(readPoleMap(file), Error) << size;
  }
}

TEST_F(PoleMapFileTest, RefusesEverySingleFlippedBit) {
  PoleMapData data;
  data.poles = {variedMapPole(1, 2), variedMapPole(3, 4)};
  data.info = {{"key", "value"}};
  writePoleMap(path("whole.polemap"), data);
  const std::string bytes = read(path("whole.polemap"));
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string damaged = bytes;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    const fs::path file = write("m.polemap", damaged);
    EXPECT_THROW(readPoleMap(file), Error) << bit;
  }
}

TEST_F(PoleMapFileTest, DamageUnderARightChecksumNeverCrashes) {
  // The checksum does not protect the parser here: it must read or throw an Error.
  const std::string payload = chunk("INFO", std::string("\1\0\0\0\1\0\0\0k\2\0\0\0vw", 15)) +
                              poleChunk(kFieldsByHand, 1, "");
  std::mt19937_64 generator(5);
  int refused = 0, read = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string damaged = payload;
    for (int k = 0; k < 1 + i % 4; ++k) {
      damaged[generator() % damaged.size()] = static_cast<char>(generator());
    }
    if (i % 3 == 0) damaged.resize(generator() % damaged.size());
    const fs::path file = write("m.polemap", wrapped(damaged));
    try {
      readPoleMap(file);
      ++read;
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(read, 100);
}

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

TEST_F(MapScans, RefuseTimesAndSensorsThatCannotBe) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto refusal = [](const auto& change) {
    AddedSessions scans = sample();
    AddedSession& session = scans.sessions[0];
    const auto used = std::find(session.used.begin(), session.used.end(), true);
    change(session.scans[static_cast<std::size_t>(used - session.used.begin())]);
    return messageOf([&] { unpackMapScans(packMapScans(scans), "x: "); });
  };
  for (const double value : {none, 1e300, -1e300}) {
    EXPECT_HAS(refusal([&](SessionScan& scan) { scan.time = value; }), "x: damaged: the time of");
    EXPECT_HAS(refusal([&](SessionScan& scan) { scan.pose_robot_sensor.x = value; }),
               "x: damaged: a sensor of");
    EXPECT_HAS(refusal([&](SessionScan& scan) { scan.pose_robot_sensor.y = value; }),
               "x: damaged: a sensor of");
  }
  EXPECT_HAS(refusal([&](SessionScan& scan) { scan.pose_robot_sensor.yaw = none; }),
             "x: damaged: a sensor of");
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

}  // namespace polemcl::test_pole_map_file
