// False lengths and counts in files must give an error and must not allocate memory.

#include <zlib.h>

#include <functional>

#include "io/data/PcdFile.h"
#include "io/dataset/NcltScans.h"
#include "io/file/Bytes.h"
#include "io/file/Decompress.h"
#include "io/file/Npz.h"
#include "io/file/ReadLimits.h"
#include "io/file/TextFile.h"
#include "io/map/PoleMapFile.h"
#include "support/IoFiles.h"
#include "support/MemoryTaken.h"
#include "support/NcltSamples.h"
#include "support/NumpyFiles.h"

namespace polemcl::test_forged_lengths {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;
using namespace polemcl::tests;

constexpr std::size_t kMegabyte = 1 << 20;

class ForgedLengths : public FolderTest {
 protected:
  /// The error message of `reading`, which may take at most `most` bytes.
  static std::string refusal(const std::function<void()>& reading, std::size_t most = kMegabyte) {
    std::string message;
    const std::size_t taken = memoryTakenBy([&] { message = messageOf(reading); });
    EXPECT_LT(taken, most) << message;
    EXPECT_NE(message, "no error");
    return message;
  }
};

std::string zlibbed(const std::string& content) {
  std::string result(compressBound(content.size()), '\0');
  uLongf size = result.size();
  compress(reinterpret_cast<Bytef*>(result.data()), &size,
           reinterpret_cast<const Bytef*>(content.data()), content.size());
  result.resize(size);
  return result;
}

/// A `.polemap` with one chunk of these bytes and a valid checksum.
std::string poleMap(const std::string& tag, const std::string& content,
                    std::uint64_t chunkBytes = ~0ull) {
  ByteWriter payload;
  payload.putRaw(tag);
  payload.put(chunkBytes == ~0ull ? static_cast<std::uint64_t>(content.size()) : chunkBytes);
  payload.putRaw(content);
  ByteWriter file;
  file.putRaw(std::string_view("\x89PMAP\r\n\x1a", 8));
  file.put(std::uint32_t{1});
  file.put(static_cast<std::uint64_t>(payload.bytes().size()));
  file.put(
      static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(payload.bytes().data()),
                                       static_cast<uInt>(payload.bytes().size()))));
  file.putRaw(payload.bytes());
  return file.bytes();
}

TEST_F(ForgedLengths, TheCounterSeesWhatTheLibraryTakes) {
  const fs::path file = write("a.bin", std::string(3 * kMegabyte, 'x'));
  EXPECT_GT(memoryTakenBy([&] { readBytes(file); }), 3 * kMegabyte);
}

TEST_F(ForgedLengths, InAPoleMap) {
  const std::string poles = little(76, 4) + little(~0ull, 8) + std::string(1700, '\0');
  expectIn(refusal([&] { readPoleMap(write("a.polemap", poleMap("POLE", poles))); }), "a.polemap",
           "18446744073709551615 poles");
  const std::string chunk = poleMap("POLE", std::string(1700, '\0'), 1ull << 40);
  expectIn(refusal([&] { readPoleMap(write("a.polemap", chunk)); }), "a.polemap", "1099511627776");
  const std::string texts = little(0xffffffff, 4) + little(0xfffffff0, 4) + "key";
  expectIn(refusal([&] { readPoleMap(write("a.polemap", poleMap("INFO", texts))); }), "a.polemap",
           "4294967280 bytes expected");
}

TEST_F(ForgedLengths, InTheScansOfAMap) {
  const std::string data = zlibbed(std::string(20, '\1'));
  const auto unpack = [&](std::uint64_t size, const std::string& packed) {
    return refusal([&] { unpackMapScans(little(size, 8) + packed, "x: "); });
  };
  expectIn(unpack(1ull << 40, data), "x: ", "cannot hold 1099511627776");
  // A size that deflate could just reach, but this data does not.
  const std::string large = data + std::string(100000, 'x');
  expectIn(unpack(20 * kMegabyte, large), "x: ", "cannot be decompressed");
  for (const std::uint64_t sessions : {0xffffffffull, 2ull}) {
    const std::string scans = zlibbed(little(0, 8) + little(sessions, 4) + little(1, 4) + "s" +
                                      little(~0ull, 8) + std::string(200, '\0'));
    expectIn(unpack(8 + 4 + 4 + 1 + 8 + 200, scans), "x: ", "do not fit");
  }
}

TEST_F(ForgedLengths, InCompressedData) {
  const std::string content(5 * kMegabyte, 'a'), packed = zlibbed(content);
  EXPECT_EQ(inflated(packed, content.size(), "x: "), content);
  EXPECT_EQ(inflated(zlibbed(""), 0, "x: "), "");
  for (const std::uint64_t size : {std::uint64_t{0}, content.size() - 1, content.size() + 1})
    EXPECT_REFUSED(inflated(packed, size, "x: "), "x: ");
  // Data beyond a small claimed size are not decompressed.
  refusal([&] { inflated(packed, 100, "x: "); });
  EXPECT_REFUSED(inflated(packed + "x", content.size(), "x: "), "cannot be decompressed");
}

TEST_F(ForgedLengths, InAnArchiveOfArrays) {
  const std::string array =
      npy(dictionary("<f8", "False", "(1000000000000,)"), std::string(1000, '\0'));
  const auto open = [&](const std::string& bytes) {
    const fs::path file = write("a.npz", bytes);
    return refusal([&] { NpzFile(file).array("a"); });
  };
  expectIn(open(zip({{"a.npy", array}})), "a.npz", "do not fit its shape");
  std::string claim = zip({{"a.npy", array}});
  claim.replace(claim.find("PK\x01\x02") + 24, 4, little(20 * kMegabyte, 4));
  expectIn(open(claim), "a.npz", "beyond its end");
}

TEST_F(ForgedLengths, InPointClouds) {
  const auto cloud = [&](const std::string& points, const std::string& kind,
                         const std::string& data) {
    const fs::path file =
        write("a.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nPOINTS " + points +
                           "\nDATA " + kind + "\n" + data);
    return refusal([&] { readPcd(file); });
  };
  for (const char* kind : {"binary", "ascii"})
    expectIn(cloud("1000000000000", kind, "1 2 3\n"), "a.pcd", "cut short");
  const std::string data(1700, '\0');
  expectIn(cloud("300000000", "binary_compressed", little(1700, 4) + little(3600000000, 4) + data),
           "a.pcd", "1700 bytes of compressed points cannot hold 3600000000");
  expectIn(cloud("300000000", "binary_compressed", little(~0u, 4) + little(3600000000, 4) + data),
           "a.pcd", "cut short");
}

TEST_F(ForgedLengths, InPacketsOfNclt) {
  for (const std::uint64_t points : {99999ull, 100001ull, 0xffffffffull}) {
    std::string packet = testing_nclt::packet(1, std::string(1600, '\0'));
    packet.replace(8, 4, little(points, 4));
    const fs::path file = write("velodyne_hits.bin", packet);
    std::vector<std::string> notes;
    expectIn(refusal([&] { findNcltTurns(file, notes); }), "velodyne_hits.bin",
             points > 100000 ? "at most 100000 are allowed" : "cut short");
  }
}

// A small file that decompresses to more text than the limit.
TEST_F(ForgedLengths, InCompressedText) {
  const fs::path file = path("a.txt.gz");
  const gzFile stream = gzopen(file.c_str(), "wb1");
  const std::string line(kMegabyte, '1');
  for (std::size_t i = 0; i <= kMostTextBytes / kMegabyte; ++i)
    gzwrite(stream, line.data(), static_cast<unsigned>(line.size()));
  gzclose(stream);
  expectIn(refusal([&] { readLines(file); }, 4 * kMostTextBytes), "a.txt.gz",
           "MB of text, uncompressed");
}

}  // namespace
}  // namespace polemcl::test_forged_lengths
