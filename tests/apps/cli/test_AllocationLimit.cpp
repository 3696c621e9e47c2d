// Programs take no memory for what a rawlog only claims to hold.

#include <gtest/gtest.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRange.h>

#include "support/Samples.h"
#include "support/Shell.h"

namespace polemcl::test_allocation_limit {
namespace {

using namespace testing_apps;

const fs::path bin = POLEMCL_BIN_DIR;

std::string number(std::uint32_t value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string forged(std::string bytes, const std::string& there, const std::string& instead) {
  const auto at = bytes.find(there);
  EXPECT_NE(at, std::string::npos);
  return bytes.replace(at, there.size(), instead);
}

/// With 1 GB of address space.
Outcome extract(const std::string& arguments) {
  return shell("ulimit -v 1000000; '" + (bin / "pole-extract").string() + "' " + arguments);
}

/// A rawlog in which one number is another takes neither the memory that it claims nor 1 GB.
void expectRefused(const mrpt::obs::CObservation& observation, const std::string& there,
                   const std::string& instead) {
  const TempFolder folder;
  writeText(folder / "forged.rawlog", forged(samples::bytesOf(observation), there, instead));
  const Outcome outcome = extract("--inspect '" + (folder / "forged.rawlog").string() + "'");
  EXPECT_EQ(outcome.code, 1) << outcome.out;
  EXPECT_HAS(outcome.out, "forged.rawlog: truncated: the file ends inside an object");
}

// Without the limit, MRPT asks for the memory: the program has it, or ends with std::bad_alloc or
// SIGSEGV.
class AllocationLimit : public testing::Test {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers have a new of their own";
#endif
  }
};

TEST_F(AllocationLimit, FalseLengthsOfLabels) {
  mrpt::obs::CObservationOdometry odometry;
  odometry.sensorLabel = "wheels";
  for (const std::uint32_t claim : {0x03000000u, 0x0fffffffu, 0xfffffff0u})
    expectRefused(odometry, number(6) + "wheels", number(claim) + "wheels");
}

TEST_F(AllocationLimit, FalseSizesOfDepthImages) {
  mrpt::obs::CObservation3DRangeScan scan;
  scan.hasRangeImage = true;
  scan.rangeImage_setSize(37, 41);
  for (const std::uint32_t claim : {10000u, 60000u})
    expectRefused(scan, number(37) + number(41), number(claim) + number(claim));
}

TEST_F(AllocationLimit, FalseNumbersOfBeams) {
  mrpt::obs::CObservation2DRangeScan scan;
  scan.resizeScanAndAssign(41, 3.F, true);
  expectRefused(scan, number(41), number(0x7fffffff));
}

// In a std::deque, which takes its memory in small pieces.
TEST_F(AllocationLimit, FalseNumbersOfRanges) {
  mrpt::obs::CObservationRange ranges;
  ranges.sensedData.resize(41);
  for (const std::uint32_t claim : {5'000'000u, 0xf0000000u})
    expectRefused(ranges, number(41), number(claim));
}

// Their memory is aligned.
TEST_F(AllocationLimit, FalseNumbersOfMeasurements) {
  mrpt::obs::CObservationBearingRange bearings;
  bearings.sensedData.resize(41);
  for (int i = 0; i < 41; ++i) bearings.sensedData[i].landmarkID = i;
  for (const std::uint32_t claim : {30'000'000u, 100'000'000u})
    expectRefused(bearings, number(41), number(claim));
}

TEST_F(AllocationLimit, FalseNumbersOfPointsInAFileBesideTheRawlog) {
  const TempFolder folder;
  mrpt::maps::CPointsMapXYZI points;
  points.resize(41);
  writeText(folder / "cloud", forged(samples::bytesOf(points), number(41), number(80'000'000)));
  mrpt::obs::CObservationPointCloud scan;
  scan.setAsExternalStorage(
      folder / "cloud",
      mrpt::obs::CObservationPointCloud::ExternalStorageFormat::MRPT_Serialization);
  writeText(folder / "scan.rawlog", samples::bytesOf(scan));
  const Outcome outcome =
      extract("--config hdl32e.ini --input '" + (folder / "scan.rawlog").string() + "' --output '" +
              (folder / "poles.rawlog").string() + "'");
  EXPECT_EQ(outcome.code, 1) << outcome.out;
  EXPECT_HAS(outcome.out, "cloud: is damaged: it cannot hold as much as it says");
}

}  // namespace
}  // namespace polemcl::test_allocation_limit
