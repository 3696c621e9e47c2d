// False lengths and counts in archives must give an error and must not allocate memory.

#include <gtest/gtest.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <zlib.h>

#include <fstream>

#include <polemcl/mrpt/map/CPoleMap.h>
#include "io/file/ReadLimits.h"
#include "mrpt/rawlog/RawlogReader.h"
#include "support/ExpectHas.h"
#include "support/MemoryTaken.h"
#include "support/Refusal.h"
#include "support/Samples.h"

namespace polemcl::test_forged_lengths_in_rawlogs {
namespace {

using samples::bytesOf;
using samples::objectFrom;

constexpr std::size_t kMegabyte = 1 << 20;

std::string number(std::uint32_t value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// The archive with one number, which occurs once, replaced by another.
std::string forged(std::string bytes, const std::string& there, const std::string& instead) {
  const auto at = bytes.find(there);
  EXPECT_NE(at, std::string::npos);
  EXPECT_EQ(bytes.find(there, at + 1), std::string::npos);
  return bytes.replace(at, there.size(), instead);
}

/// Error message of MRPT for an archive that must be rejected without much memory.
std::string refusal(const std::string& bytes) {
  std::string message;
  const std::size_t taken = tests::memoryTakenBy([&] {
    try {
      objectFrom(bytes);
      ADD_FAILURE() << "accepted";
    } catch (const std::exception& error) {
      message = error.what();
    }
  });
  EXPECT_LT(taken, kMegabyte) << message;
  return message;
}

/// Error message for a rawlog of these bytes, which must be rejected without much memory.
std::string rawlogRefusal(const testing_apps::TempFolder& folder, const std::string& bytes,
                          bool compressed = false, std::size_t most = 2 * kMegabyte) {
  const std::string path = folder / "s.rawlog";
  const gzFile file = gzopen(path.c_str(), compressed ? "wb" : "wbT");
  gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size()));
  gzclose(file);
  std::string message;
  const std::size_t taken = tests::memoryTakenBy([&] {
    message = tests::messageOf([&] {
      RawlogReader reader(path);
      RawlogEntry entry;
      while (reader.next(entry)) {
      }
    });
  });
  EXPECT_NE(message, "no error");
  EXPECT_LT(taken, most) << message;
  return message;
}

CObservationPoles scanOf(std::size_t poles) {
  CObservationPoles scan = samples::observation();
  scan.sensorLabel = "LIDAR of a forger";
  scan.poles.assign(poles, samples::pole(5, 0));
  scan.visibilityRange.assign(128, 7.f);
  return scan;
}

const std::vector<std::uint32_t> kClaims{70000, 220'000'000, 0xffffffff};

TEST(ForgedLengths, OfVisibilityRanges) {
  const std::string ranges(number(128) + number(0x40e00000));  // 7
  for (const std::uint32_t claim : kClaims) {
    const std::string bytes =
        forged(bytesOf(scanOf(2)), ranges, number(claim) + number(0x40e00000));
    EXPECT_HAS(refusal(bytes), std::to_string(claim) + " visibility ranges");
  }
  // Within the limit, but more than the data hold.
  refusal(forged(bytesOf(scanOf(2)), ranges, number(65536) + number(0x40e00000)));
}

TEST(ForgedLengths, OfPoles) {
  CObservationPoles scan = scanOf(2);
  scan.points = 0x01020304;
  for (const std::uint32_t claim : kClaims) {
    const std::string bytes =
        forged(bytesOf(scan), number(scan.points) + number(2), number(scan.points) + number(claim));
    EXPECT_HAS(refusal(bytes), std::to_string(claim) + " poles");
  }
}

TEST(ForgedLengths, OfALabel) {
  const std::string label = "LIDAR of a forger";
  for (const std::uint32_t claim : kClaims) {
    const std::string bytes =
        forged(bytesOf(scanOf(2)), number(static_cast<std::uint32_t>(label.size())) + label,
               number(claim) + label);
    EXPECT_HAS(refusal(bytes), std::to_string(claim) + " bytes of sensor label");
  }
}

TEST(ForgedLengths, WhatCannotBeReadIsNotWritten) {
  EXPECT_NO_THROW(bytesOf(scanOf(io::kMostOfAScan)));
  EXPECT_ANY_THROW(bytesOf(scanOf(io::kMostOfAScan + 1)));
  CPoleMap map;
  map.info["config"] = std::string(io::kLongestMapFact + 1, 'x');
  EXPECT_ANY_THROW(bytesOf(map));
  map.info.clear();
  for (std::uint32_t i = 0; i < io::kMostMapFacts; ++i) map.info[std::to_string(i)] = "x";
  EXPECT_NO_THROW(bytesOf(map));
  map.info["one more"] = "x";
  EXPECT_ANY_THROW(bytesOf(map));
}

TEST(ForgedLengths, OfAMap) {
  CPoleMap map;
  MapPole pole;
  pole.x = 3;
  map.setPoles({pole});
  map.info = {{"program", "pole-map"}, {"scans", "12"}};
  const std::string good = bytesOf(map);
  const auto read = std::dynamic_pointer_cast<CPoleMap>(objectFrom(good));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->info, map.info);
  EXPECT_EQ(read->poles().size(), 1u);

  const std::string facts = number(2) + number(7) + "program", last = number(2) + "12" + number(1);
  for (const std::uint32_t claim : {0x0fffffffu, 0xffffffffu}) {
    EXPECT_HAS(refusal(forged(good, facts, number(claim) + number(7) + "program")),
               std::to_string(claim) + " facts");
    EXPECT_HAS(refusal(forged(good, facts, number(2) + number(claim) + "program")),
               std::to_string(claim) + " bytes of facts");
    EXPECT_HAS(refusal(forged(good, last, number(claim) + "12" + number(1))),
               std::to_string(claim) + " bytes of facts");
    EXPECT_HAS(refusal(forged(good, last, number(2) + "12" + number(claim))),
               std::to_string(claim) + " poles");
    EXPECT_HAS(refusal(forged(good, number(8) + "std::map", number(claim) + "std::map")),
               std::to_string(claim) + " bytes of facts");
  }
}

TEST(ForgedLengths, InARawlogOfPoles) {
  const testing_apps::TempFolder folder;
  mrpt::obs::CSensoryFrame frame;
  frame.insert(std::make_shared<CObservationPoles>(scanOf(10)));
  const std::string good = bytesOf(frame);
  const std::string bad =
      forged(good, number(128) + number(0x40e00000), number(220'000'000) + number(0x40e00000));
  for (const bool compressed : {false, true}) {
    const std::string message = rawlogRefusal(folder, good + bad, compressed);
    EXPECT_HAS(message, "s.rawlog: object 1 at byte " + std::to_string(good.size()));
    EXPECT_HAS(message, "220000000 visibility ranges");
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

// MRPT allocates memory for the points before it reads them: the reader must check first.
TEST(ForgedLengths, InARawlogOfScans) {
  const testing_apps::TempFolder folder;
  auto cloud = mrpt::obs::CObservationPointCloud::Create();
  auto points = mrpt::maps::CPointsMapXYZI::Create();
  points->resize(200);
  for (int i = 0; i < 200; ++i) points->setPointFast(i, 1.5f, 0.5f, 1.f);
  cloud->pointcloud = points;
  mrpt::obs::CSensoryFrame frame;
  frame.insert(cloud);
  const std::string good = bytesOf(frame);
  for (const std::uint32_t claim : {400u, 3'000'000'000u}) {
    const std::string bad =
        forged(good, number(200) + number(0x3fc00000), number(claim) + number(0x3fc00000));
    EXPECT_HAS(rawlogRefusal(folder, good + bad), "truncated: the file ends inside an object");
  }
  const std::string bad =
      forged(good, number(200) + number(0x3fc00000), number(3'000'000'000) + number(0x3fc00000));
  EXPECT_HAS(rawlogRefusal(folder, good + bad, true), "truncated: the file ends inside");
}

std::string header(const std::string& name) {
  return static_cast<char>(0x80 | name.size()) + name;
}

// MRPT follows the pointers of a collection without a look at them, and crashes.
TEST(ForgedLengths, ElementsOfCollectionsThatAreNullOrForeign) {
  const testing_apps::TempFolder folder;
  const std::string null = header("nullptr") + "\x88", end = "\x88", zero(1, '\0');
  const std::string pose = bytesOf(mrpt::poses::CPose2D());
  const std::string actions = header("mrpt::obs::CActionCollection") + zero + number(1);
  for (const std::string& version : {std::string("\0", 1), std::string("\1"), std::string("\2")}) {
    const std::string frame = header("mrpt::obs::CSensoryFrame") + version +
                              (version == "\2" ? "" : number(7)) +
                              (version == zero ? std::string(8, '\1') : "") + number(1);
    EXPECT_HAS(rawlogRefusal(folder, frame + null + end),
               "element 0 of its collection is null, not an observation");
    EXPECT_HAS(rawlogRefusal(folder, frame + pose + end),
               "is a mrpt::poses::CPose2D, not an observation");
  }
  EXPECT_HAS(rawlogRefusal(folder, actions + null + end),
             "element 0 of its collection is null, not an action");
  EXPECT_HAS(rawlogRefusal(folder, actions + pose + end),
             "is a mrpt::poses::CPose2D, not an action");
}

// MRPT follows the pointer to the distribution, too.
TEST(ForgedLengths, MovementsWithoutADistribution) {
  const testing_apps::TempFolder folder;
  const std::string name = header("mrpt::obs::CActionRobotMovement2D"), method = number(1);
  const std::string actions =
      header("mrpt::obs::CActionCollection") + std::string(1, '\0') + number(1);
  const std::string abstract = header("mrpt::poses::CPosePDF") + std::string(1, '\0');
  for (const std::string& other :
       {header("nullptr") + "\x88", bytesOf(mrpt::poses::CPose2D()), abstract})
    for (const std::string& version :
         {std::string(1, '\0'), std::string("\1"), "\2" + method, "\3" + method, "\7" + method})
      EXPECT_HAS(rawlogRefusal(folder, actions + name + version + other),
                 "a movement without a distribution of poses");
}

TEST(ForgedLengths, MovementsAreReadAsTheyWereWritten) {
  const testing_apps::TempFolder folder;
  mrpt::obs::CActionRobotMovement2D movement;
  mrpt::poses::CPosePDFGaussian distribution;
  distribution.mean = {1, 2, 3};
  movement.poseChange = mrpt::poses::CPosePDFGaussian::Create(distribution);
  movement.encoderLeftTicks = 7;
  movement.hasEncodersInfo = true;
  for (const auto method : {mrpt::obs::CActionRobotMovement2D::emScan2DMatching,
                            mrpt::obs::CActionRobotMovement2D::emOdometry}) {
    movement.estimationMethod = method;
    movement.rawOdometryIncrementReading = {1, 2, 3};
    mrpt::obs::CActionCollection actions;
    actions.insert(movement);
    const std::string path = folder / "movement.rawlog";
    std::ofstream(path, std::ios::binary) << bytesOf(actions);
    RawlogReader reader(path);
    RawlogEntry entry;
    ASSERT_TRUE(reader.next(entry) && entry.action);
    const auto read = entry.action->getActionByClass<mrpt::obs::CActionRobotMovement2D>();
    ASSERT_TRUE(read);
    EXPECT_NEAR(read->poseChange->getMeanVal().y(), 2, 1e-6);
    EXPECT_EQ(read->encoderLeftTicks, 7);
  }
}

TEST(ForgedLengths, CountsOfCollections) {
  const testing_apps::TempFolder folder;
  for (const char* name : {"mrpt::obs::CActionCollection", "mrpt::obs::CSensoryFrame"}) {
    const std::string version = name[12] == 'A' ? std::string(1, '\0') : "\2";
    EXPECT_HAS(rawlogRefusal(folder, header(name) + version + number(3'000'000'000)),
               "truncated: the file ends inside an object");
  }
}

TEST(ForgedLengths, CollectionsOfTooManyElements) {
  const testing_apps::TempFolder folder;
  std::string elements;
  for (int i = 0; i < 4097; ++i) elements += bytesOf(mrpt::obs::CObservationOdometry());
  EXPECT_HAS(rawlogRefusal(
                 folder, header("mrpt::obs::CSensoryFrame") + '\2' + number(4097) + elements, true),
             "a collection of more than 4096 elements");
}

TEST(ForgedLengths, ObjectsLargerThanTheirFileCanHold) {
  const testing_apps::TempFolder folder;
  mrpt::obs::CObservationComment comment;
  comment.text.assign(kMegabyte, ' ');
  std::string elements;
  for (int i = 0; i < 20; ++i) elements += bytesOf(comment);
  EXPECT_HAS(
      rawlogRefusal(folder, header("mrpt::obs::CSensoryFrame") + '\2' + number(20) + elements, true,
                    40 * kMegabyte),
      "it holds more than 17 MB; no object of a file of this size does");
}

// Frames of MRPT before 0.5.5 and of each version since hold the same observations.
TEST(ForgedLengths, OldCollectionsAreRead) {
  const testing_apps::TempFolder folder;
  mrpt::obs::CObservationOdometry odometry;
  odometry.timestamp = mrpt::Clock::fromDouble(5);
  const std::string element = bytesOf(odometry);
  const std::uint64_t ticks = mrpt::Clock::fromDouble(9).time_since_epoch().count();
  const std::string time(reinterpret_cast<const char*>(&ticks), sizeof ticks);
  const std::string name = "mrpt::obs::CSensoryFrame";
  const auto timeOf = [&](const std::string& bytes) {
    const std::string path = folder / "old.rawlog";
    std::ofstream(path, std::ios::binary) << bytes;
    RawlogReader reader(path);
    RawlogEntry entry;
    EXPECT_TRUE(reader.next(entry) && entry.frame && entry.frame->size() == 1) << bytes;
    return mrpt::Clock::toDouble((*entry.frame->begin())->timestamp);
  };
  const std::string list = number(1) + element, end = "\x88";
  EXPECT_EQ(timeOf(header(name) + '\2' + list + end), 5);
  EXPECT_EQ(timeOf(header(name) + '\1' + number(7) + list + end), 5);
  EXPECT_EQ(timeOf(header(name) + '\0' + number(7) + time + list + end), 9);
  EXPECT_EQ(timeOf(number(static_cast<std::uint32_t>(name.size())) + name + number(2) + list), 5);
}

}  // namespace
}  // namespace polemcl::test_forged_lengths_in_rawlogs
