#include <dlfcn.h>
#include <gtest/gtest.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CSerializable.h>
#include <mrpt/version.h>
#include <zlib.h>

#include <chrono>
#include <fstream>
#include <new>
#include <set>
#include <thread>

#include "mrpt/rawlog/RawlogReader.h"
#include "support/ExpectHas.h"
#include "support/Samples.h"

namespace {
bool s_zlibHasMemory = true;
}

/// In place of zlib's.
extern "C" const char* gzerror(gzFile file, int* code) {
  using Function = const char* (*)(gzFile, int*);
  static const auto real = reinterpret_cast<Function>(::dlsym(RTLD_NEXT, "gzerror"));
  const char* const text = real(file, code);
  if (!s_zlibHasMemory) *code = Z_MEM_ERROR;
  return text;
}

namespace polemcl::test_rawlog_reader {

/// An object for which there is not enough memory.
class CTooLarge : public mrpt::serialization::CSerializable {
  DEFINE_SERIALIZABLE(CTooLarge, polemcl::test_rawlog_reader)
};
IMPLEMENTS_SERIALIZABLE(CTooLarge, CSerializable, polemcl::test_rawlog_reader)
std::uint8_t CTooLarge::serializeGetVersion() const {
  return 0;
}
void CTooLarge::serializeTo(mrpt::serialization::CArchive&) const {}
void CTooLarge::serializeFrom(mrpt::serialization::CArchive&, std::uint8_t) {
  throw std::bad_alloc();
}

namespace {

using namespace mrpt::obs;

std::string action(double dx) {
  CActionRobotMovement2D move;
  move.estimationMethod = CActionRobotMovement2D::emScan2DMatching;
  move.poseChange = mrpt::poses::CPosePDFGaussian::Create(mrpt::poses::CPose2D(dx, 0, 0.1),
                                                          mrpt::math::CMatrixDouble33::Identity());
  CActionCollection actions;
  actions.insert(move);
  return samples::bytesOf(actions);
}

std::string frame(double x) {
  auto scan = std::make_shared<CObservationPoles>(samples::observation());
  scan->poles[0].x = x;
  CSensoryFrame frame;
  frame.insert(scan);
  return samples::bytesOf(frame);
}

std::string odometry(double x) {
  CObservationOdometry odo;
  odo.odometry = mrpt::poses::CPose2D(x, 0, 0);
  return samples::bytesOf(odo);
}

std::string cloudFrame() {
  auto cloud = CObservationPointCloud::Create();
  auto points = mrpt::maps::CPointsMapXYZI::Create();
  points->resize(200);
  for (int i = 0; i < 200; ++i) points->setPointFast(i, static_cast<float>(i), 0.5F, 1.F);
  cloud->pointcloud = points;
  CSensoryFrame frame;
  frame.insert(cloud);
  return samples::bytesOf(frame);
}

void writeFile(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<long>(bytes.size()));
}

std::string gzipped(const std::string& bytes, const testing_apps::TempFolder& folder) {
  gzFile file = gzopen((folder / "tmp.gz").c_str(), "wb");
  gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size()));
  gzclose(file);
  std::ifstream in(folder / "tmp.gz", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Result of a reading: entries until the end or the error.
struct Reading {
  std::vector<RawlogEntry> entries;
  bool truncated = false;
  std::string error;
};

Reading readAll(const std::string& path, bool allowTruncated = false) {
  Reading reading;
  try {
    RawlogReader reader(path, allowTruncated);
    RawlogEntry entry;
    while (reader.next(entry)) reading.entries.push_back(entry);
    EXPECT_FALSE(reader.next(entry));  // still at the end
    reading.truncated = reader.truncated();
  } catch (const Error& error) {
    reading.error = error.what();
  }
  return reading;
}

/// A folder with one rawlog of given bytes.
struct Bench {
  testing_apps::TempFolder folder;
  std::string path = folder / "s.rawlog";
  Reading read(const std::string& bytes, bool allowTruncated = false) const {
    writeFile(path, bytes);
    return readAll(path, allowTruncated);
  }
};

struct RawlogReaderTest : testing::Test {
  const Bench bench{};
};

TEST_F(RawlogReaderTest, ReadsPairs) {
  const std::string bytes = action(1) + frame(10) + action(2) + frame(20);
  for (const std::string& data : {bytes, gzipped(bytes, bench.folder)}) {
    const Reading reading = bench.read(data);
    ASSERT_EQ(reading.error, "");
    ASSERT_EQ(reading.entries.size(), 2u);
    EXPECT_FALSE(reading.truncated);
    const auto& entry = reading.entries[1];
    ASSERT_TRUE(entry.action && entry.frame);
    EXPECT_FALSE(entry.observation);
    EXPECT_EQ(entry.offset, (action(1) + frame(10)).size());
    EXPECT_NEAR(entry.action->getBestMovementEstimation()->poseChange->getMeanVal().x(), 2, 1e-9);
    EXPECT_EQ(entry.frame->getObservationByClass<CObservationPoles>()->poles[0].x, 20);
  }
}

TEST_F(RawlogReaderTest, LackOfMemoryIsNoDamageOfTheFile) {
  mrpt::rtti::registerClass(CLASS_ID(CTooLarge));
  const std::string bytes = action(1) + frame(10) + samples::bytesOf(CTooLarge());
  for (const bool allowTruncated : {false, true})
    EXPECT_THROW(bench.read(bytes, allowTruncated), std::bad_alloc);
}

TEST_F(RawlogReaderTest, LackOfMemoryInZlibIsNoEndOfTheFile) {
  writeFile(bench.path, gzipped(action(1) + frame(10), bench.folder));
  s_zlibHasMemory = false;
  EXPECT_THROW(readAll(bench.path, true), std::bad_alloc);
  s_zlibHasMemory = true;
}

TEST_F(RawlogReaderTest, WaitsAtTheEndOfAFileThatGrows) {
  const std::string bytes = action(1) + frame(10) + action(2) + frame(20);
  for (const std::string& data : {bytes, gzipped(bytes, bench.folder)}) {
    const std::size_t half = data.size() / 2;
    writeFile(bench.path, data.substr(0, half));
    RawlogReader reader(bench.path, false, 5);
    std::thread writer([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
      std::ofstream(bench.path, std::ios::app | std::ios::binary) << data.substr(half);
    });
    RawlogEntry entry;
    EXPECT_TRUE(reader.next(entry));
    EXPECT_TRUE(reader.next(entry));
    EXPECT_EQ(entry.frame->getObservationByClass<CObservationPoles>()->poles[0].x, 20);
    writer.join();
  }
}

TEST_F(RawlogReaderTest, ReadsBareObservations) {
  CObservationComment comment;
  comment.text = "made by a test";
  const Reading reading = bench.read(samples::bytesOf(comment) + odometry(1) +
                                     samples::bytesOf(samples::observation()));
  ASSERT_EQ(reading.error, "");
  ASSERT_EQ(reading.entries.size(), 2u);
  EXPECT_TRUE(std::dynamic_pointer_cast<CObservationOdometry>(reading.entries[0].observation));
  EXPECT_TRUE(std::dynamic_pointer_cast<CObservationPoles>(reading.entries[1].observation));
  EXPECT_FALSE(reading.entries[0].action || reading.entries[0].frame);
}

// MRPT's reader loses the first of two actions, and frames without an action.
TEST_F(RawlogReaderTest, LosesNoActionAndNoFrame) {
  const Reading reading =
      bench.read(frame(1) + action(1) + action(2) + frame(2) + action(3) + odometry(7) + frame(3));
  ASSERT_EQ(reading.error, "");
  ASSERT_EQ(reading.entries.size(), 6u);
  EXPECT_TRUE(!reading.entries[0].action && reading.entries[0].frame);
  EXPECT_TRUE(reading.entries[1].action && !reading.entries[1].frame);
  EXPECT_TRUE(reading.entries[2].action && reading.entries[2].frame);
  EXPECT_TRUE(reading.entries[3].action && !reading.entries[3].frame);
  EXPECT_TRUE(reading.entries[4].observation);
  EXPECT_TRUE(!reading.entries[5].action && reading.entries[5].frame);
}

TEST_F(RawlogReaderTest, KeepsAMegabyteOfComments) {
  std::string bytes;
  for (const std::size_t size : {600000u, 600000u, 400000u}) {
    CObservationComment comment;
    comment.text.assign(size, static_cast<char>('0' + size / 100000));
    bytes += samples::bytesOf(comment);
  }
  writeFile(bench.path, bytes + odometry(1));
  RawlogReader reader(bench.path);
  RawlogEntry entry;
  EXPECT_TRUE(reader.next(entry));
  EXPECT_EQ(reader.comment(), std::string(600000, '6') + '\n' + std::string(400000, '4'));
}

TEST_F(RawlogReaderTest, JoinedFilesAreOneFile) {
  const std::string one = action(1) + frame(1), two = action(2) + frame(2);
  EXPECT_EQ(bench.read(one + two).entries.size(), 2u);
  EXPECT_EQ(bench.read(gzipped(one, bench.folder) + gzipped(two, bench.folder)).entries.size(), 2u);
}

// At many lengths: either an error that says "truncated" and where, or, if allowed, all entries
// before. Only a cut between two objects cannot be detected.
TEST_F(RawlogReaderTest, TruncatedAnywhere) {
  const std::size_t a = action(1).size(), f = frame(1).size();
  const std::string bytes = action(1) + frame(1) + action(2) + frame(2);
  const std::set<std::size_t> between = {a, a + f, 2 * a + f};
  std::set<std::size_t> sizes = {1, a - 1, a + 1, a + f - 1, a + f + 1};
  sizes.insert(between.begin(), between.end());
  for (std::size_t size = 2; size < bytes.size(); size += 11) sizes.insert(size);
  for (const std::size_t size : sizes) {
    const Reading strict = bench.read(bytes.substr(0, size));
    if (between.count(size)) {
      EXPECT_EQ(strict.error, "");
    } else {
      EXPECT_HAS(strict.error, "s.rawlog: truncated: ");
      EXPECT_HAS(strict.error, "starts at byte ");
    }
    const Reading lax = bench.read(bytes.substr(0, size), true);
    EXPECT_EQ(lax.error, "") << size;
    std::size_t frames = 0;
    for (const auto& entry : lax.entries) frames += entry.frame != nullptr;
    EXPECT_EQ(frames, size < a + f ? 0u : 1u) << size;
    EXPECT_EQ(lax.truncated, !between.count(size)) << size;
  }
}

TEST_F(RawlogReaderTest, TruncatedInsideABigVector) {
  const std::string bytes = frame(1) + cloudFrame();
  const std::size_t cut = bytes.size() - 1000;
  const Reading strict = bench.read(bytes.substr(0, cut));
  EXPECT_HAS(strict.error, "truncated: the file ends inside an object that starts at byte " +
                               std::to_string(frame(1).size()));
  EXPECT_EQ(bench.read(bytes.substr(0, cut), true).entries.size(), 1u);
}

TEST_F(RawlogReaderTest, TruncatedGzip) {
  std::string bytes;
  for (int i = 0; i < 50; ++i) bytes += action(i) + frame(i * 1.1);
  const std::string packed = gzipped(bytes, bench.folder);
  for (const std::size_t size : {packed.size() - 1, packed.size() - 8, packed.size() / 2}) {
    EXPECT_HAS(bench.read(packed.substr(0, size)).error, "truncated");
    const Reading lax = bench.read(packed.substr(0, size), true);
    EXPECT_EQ(lax.error, "");
    EXPECT_TRUE(lax.truncated);
    EXPECT_LE(lax.entries.size(), 50u);
    EXPECT_GT(lax.entries.size(), 5u);
  }
}

// Any number of small objects would take memory where all are kept.
TEST_F(RawlogReaderTest, RefusesMoreThanAFileOfItsSizeCanHold) {
  CObservationComment comment;
  comment.text.assign(8 << 20, ' ');
  const std::string part = gzipped(samples::bytesOf(comment), bench.folder);
  std::string bytes;
  for (int i = 0; i < 45; ++i) bytes += part;
  EXPECT_HAS(bench.read(bytes).error, "MB, uncompressed; no rawlog of its size does");
}

TEST_F(RawlogReaderTest, EmptyFile) {
  EXPECT_HAS(bench.read("").error, "is empty");
  const Reading lax = bench.read("", true);
  EXPECT_EQ(lax.error, "");
  EXPECT_TRUE(lax.truncated);
}

TEST_F(RawlogReaderTest, NamesZstd) {
  EXPECT_HAS(bench.read(std::string("\x28\xB5\x2F\xFD") + action(0)).error, "zstd -d");
}

/// The same bytes with a class name replaced by another of the same length.
std::string renamed(std::string bytes, const std::string& from, const std::string& to) {
  const auto at = bytes.find(from);
  EXPECT_NE(at, std::string::npos);
  return bytes.replace(at, from.size(), to);
}

TEST_F(RawlogReaderTest, NamesUnknownClasses) {
  const std::string strange =
      renamed(odometry(1), "mrpt::obs::CObservationOdometry", "other::lib::CObservationUnheard");
  const std::string inFrame =
      renamed(frame(1), "polemcl::CObservationPoles", "polemcl::CObservationPales");
  for (const bool allow : {false, true}) {
    const Reading bare = bench.read(odometry(0) + strange, allow);
    EXPECT_EQ(bare.error, bench.path + ": class 'other::lib::CObservationUnheard' at byte " +
                              std::to_string(odometry(0).size()) +
                              " is unknown: load the library that defines it");
    EXPECT_HAS(bench.read(action(1) + inFrame, allow).error,
               "class 'polemcl::CObservationPales' at");
  }
}

TEST_F(RawlogReaderTest, ReportsDamage) {
  std::string bytes = odometry(0) + odometry(1) + odometry(2);
  const std::size_t size = odometry(0).size();
  bytes[2 * size - 1] = 0;  // the end flag of the second
  const Reading reading = bench.read(bytes);
  EXPECT_HAS(reading.error, "s.rawlog: object 1 at byte " + std::to_string(size) + " is damaged: ");
  EXPECT_EQ(reading.error.find('\n'), std::string::npos);
  EXPECT_HAS(bench.read(bytes, true).error, "is damaged");  // damage is not truncation
}

TEST_F(RawlogReaderTest, RefusesWhatIsNoRawlog) {
  EXPECT_HAS(bench.read("x y z\n1 2 3\n4 5 6\n").error, "is not a rawlog");
  EXPECT_HAS(readAll(bench.folder / "none.rawlog").error, "none.rawlog: no such file");
  EXPECT_HAS(readAll(bench.folder / "").error, "is a folder, not a rawlog; pole-import");
  EXPECT_HAS(readAll("/dev/null").error, "is not a file");
}

// Reason for this reader: MRPT's own ends silently in all of these cases.
TEST_F(RawlogReaderTest, StockReaderStopsSilently) {
  const std::string strange =
      renamed(odometry(1), "mrpt::obs::CObservationOdometry", "other::lib::CObservationUnheard");
  const std::string whole = odometry(0) + odometry(1);
  for (const std::string& bytes :
       {odometry(0) + strange + odometry(2), whole.substr(0, whole.size() - 5)}) {
    writeFile(bench.path, bytes);
    ::testing::internal::CaptureStderr();
    CRawlog log;
    EXPECT_TRUE(log.loadFromRawLogFile(bench.path));
    ::testing::internal::GetCapturedStderr();
    EXPECT_EQ(log.size(), 1u);
    EXPECT_NE(readAll(bench.path).error, "");
  }
}

TEST_F(RawlogReaderTest, ShowsProgress) {
  std::string bytes;
  for (int i = 0; i < 3; ++i) bytes += frame(i);
  writeFile(bench.path, bytes);
  RawlogReader reader(bench.path);
  RawlogEntry entry;
  for (int i = 1; i <= 3; ++i) {
    ASSERT_TRUE(reader.next(entry));
    EXPECT_NEAR(reader.progress(), i / 3.0, 1e-9);
  }
  EXPECT_FALSE(reader.next(entry));
  EXPECT_EQ(reader.progress(), 1);
}

// Real rawlogs of many years: as many objects as MRPT's own reader finds.
TEST(RawlogReader, ReadsTheSamplesOfMrpt) {
  const std::string folder = "/usr/share/mrpt/datasets";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " (mrpt-common) is not there";
  int files = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (file.path().extension() != ".rawlog") continue;
    ++files;
    // MRPT 2.12 changed what rotating scans hold, not their version: it cannot read its own
    // samples.
    if (MRPT_VERSION >= 0x020C00 && file.path().filename().string().rfind("rot_scan", 0) == 0) {
      EXPECT_HAS(readAll(file.path().string()).error, "truncated");
      continue;
    }
    CRawlog log;
    ASSERT_TRUE(log.loadFromRawLogFile(file.path().string()));
    const Reading reading = readAll(file.path().string());
    EXPECT_EQ(reading.error, "");
    std::size_t objects = 0;
    for (const auto& entry : reading.entries)
      objects +=
          (entry.action != nullptr) + (entry.frame != nullptr) + (entry.observation != nullptr);
    EXPECT_EQ(objects, log.size()) << file.path();
  }
  EXPECT_GT(files, 3);
}

}  // namespace
}  // namespace polemcl::test_rawlog_reader
