#include <liblzf/lzf.h>

#include <vector>

#include "io/data/PcdFile.h"
#include "support/IoFiles.h"

namespace polemcl::test_pcd_file {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;

std::string header(const std::string& fields, const std::string& sizes, const std::string& types,
                   int points, const std::string& data) {
  std::string ones;
  for (std::size_t i = 0; i < types.size(); i += 2) ones += " 1";
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " +
         sizes + "\nTYPE " + types + "\nCOUNT" + ones + "\nWIDTH " + std::to_string(points) +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) + "\nDATA " +
         data + "\n";
}

template <class T>
std::string raw(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

/// Values of fields, field by field, as PCL compresses them: two sizes, then LZF data.
std::string compressed(const std::string& columns) {
  std::vector<char> packed(columns.size() + 64);
  const unsigned size = lzf_compress(columns.data(), static_cast<unsigned>(columns.size()),
                                     packed.data(), static_cast<unsigned>(packed.size()));
  EXPECT_GT(size, 0u);
  return raw<std::uint32_t>(size) + raw(static_cast<std::uint32_t>(columns.size())) +
         std::string(packed.data(), size);
}

class PcdFileTest : public FolderTest {
 protected:
  std::string refusal(const std::string& content) const {
    const fs::path file = write("a.pcd", content);
    return messageOf([&] { readPcd(file); });
  }
};

TEST_F(PcdFileTest, ReadsBinaryPoints) {
  const Cloud cloud =
      readPcd(write("a.pcd", header("x y z intensity", "4 4 4 4", "F F F F", 2, "binary") +
                                 floats({1, 2, 3, 0.5f, -4, 5, -6, 7})));
  EXPECT_EQ(cloud.x, (std::vector<float>{1, -4}));
  EXPECT_EQ(cloud.y, (std::vector<float>{2, 5}));
  EXPECT_EQ(cloud.z, (std::vector<float>{3, -6}));
  EXPECT_EQ(cloud.intensity, (std::vector<float>{0.5f, 7}));
  EXPECT_EQ(cloud.invalid, 0u);
}

TEST_F(PcdFileTest, ReadsAsciiPoints) {
  const Cloud cloud = readPcd(write("a.pcd", header("x y z", "4 4 4", "F F F", 3, "ascii") +
                                                 "1.5 -2e1 3\r\n\nnan nan nan\n0 0.25 1\n"));
  EXPECT_EQ(cloud.x, (std::vector<float>{1.5f, 0}));
  EXPECT_EQ(cloud.y, (std::vector<float>{-20, 0.25f}));
  EXPECT_EQ(cloud.z, (std::vector<float>{3, 1}));
  EXPECT_EQ(cloud.intensity, (std::vector<float>{0, 0}));
  EXPECT_EQ(cloud.invalid, 1u);
}

TEST_F(PcdFileTest, ReadsCompressedPoints) {
  // 40 points with repeating values, so that LZF can compress them.
  std::string rings, normals, x, y, z, intensity;
  std::vector<float> wanted;
  for (int i = 0; i < 40; ++i) {
    rings += raw<std::uint16_t>(7);
    normals += floats({9, 9, 9});
    wanted.push_back(0.5f * static_cast<float>(i / 8) + 1);
    x += raw(wanted.back());
    y += raw(-2.0 * wanted.back());
    z += raw(3 * wanted.back());
    intensity += raw<std::uint8_t>(200);
  }
  const std::string head =
      "FIELDS ring normal x y z intensity\nSIZE 2 4 4 8 4 1\nTYPE U F F F F U\n"
      "COUNT 1 3 1 1 1 1\nWIDTH 20\nHEIGHT 2\nPOINTS 40\nDATA binary_compressed\n";
  const std::string body = compressed(rings + normals + x + y + z + intensity);
  ASSERT_LT(body.size(), 40u * 31);
  const Cloud cloud = readPcd(write("a.pcd", head + body));
  EXPECT_EQ(cloud.x, wanted);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(cloud.y[i], -2 * wanted[i]);
    EXPECT_EQ(cloud.z[i], 3 * wanted[i]);
    EXPECT_EQ(cloud.intensity[i], 200);
  }
  // No points.
  EXPECT_EQ(readPcd(write("b.pcd", header("x y z", "4 4 4", "F F F", 0, "binary_compressed") +
                                       std::string(8, '\0')))
                .size(),
            0u);
}

TEST_F(PcdFileTest, RefusesCompressedPointsThatAreDamaged) {
  const std::string head = header("x y z", "4 4 4", "F F F", 20, "binary_compressed");
  const std::string body = compressed(std::string(240, 'a'));
  expectIn(refusal(head + body.substr(0, 5)), "a.pcd", "cut short", "5 bytes");
  expectIn(refusal(head + body.substr(0, body.size() - 1)), "a.pcd", "cut short");
  expectIn(refusal(head + compressed(std::string(228, 'a'))), "228 bytes", "20 points of 12");
  std::string damaged = body;
  damaged.replace(8, damaged.size() - 8, damaged.size() - 8, '\xff');
  expectIn(refusal(head + damaged), "a.pcd", "damaged");
}

TEST_F(PcdFileTest, FieldsMayBeOfAnyTypeAndOrder) {
  std::string content =
      "FIELDS ring time normal z x y intensity\nSIZE 2 8 4 8 4 1 2\n"
      "TYPE U F F F F I U\nCOUNT 1 1 3 1 1 1 1\nWIDTH 1\nHEIGHT 2\nDATA binary\n";
  for (const int i : {1, 2})
    content += raw<std::uint16_t>(9) + raw(0.5) + floats({7, 7, 7}) + raw(2.5 * i) +
               raw(-1.5f * static_cast<float>(i)) + raw<std::int8_t>(static_cast<std::int8_t>(-i)) +
               raw<std::uint16_t>(65535);
  const Cloud cloud = readPcd(write("a.pcd", content));
  EXPECT_EQ(cloud.x, (std::vector<float>{-1.5f, -3}));
  EXPECT_EQ(cloud.y, (std::vector<float>{-1, -2}));
  EXPECT_EQ(cloud.z, (std::vector<float>{2.5f, 5}));
  EXPECT_EQ(cloud.intensity, (std::vector<float>{65535, 65535}));
  // The same points as text.
  const std::string text =
      "FIELDS ring normal z x y\nSIZE 2 4 8 4 1\nTYPE U F F F I\n"
      "COUNT 1 3 1 1 1\nWIDTH 1\nHEIGHT 1\nDATA ascii\n9 7 7 7 2.5 -1.5 -1\n";
  EXPECT_EQ(readPcd(write("b.pcd", text)).z, (std::vector<float>{2.5f}));
}

TEST_F(PcdFileTest, AnEmptyFileIsAnEmptyCloud) {
  EXPECT_EQ(readPcd(write("a.pcd", "")).size(), 0u);
}

TEST_F(PcdFileTest, RefusesWhatIsNoPcd) {
  expectIn(refusal("ply\n"), path("a.pcd").string() + ":1: ", "'ply'");
  expectIn(refusal("VERSION 0.7\nFIELDS x y z"), "no line DATA");
  expectIn(refusal("DATA ascii\n"), "no FIELDS");
  expectIn(refusal(header("x y r", "4 4 4", "F F F", 1, "ascii") + "1 2 3\n"), "no field z");
  expectIn(refusal(header("x y z", "4 4", "F F F", 1, "ascii")), ":4: ", "SIZE for 2 fields");
  expectIn(refusal(header("x y z", "4 4 2", "F F F", 1, "ascii")), "field z", "SIZE 2");
  expectIn(refusal(header("x y z", "4 4 q", "F F F", 1, "ascii")), ":4: ", "'q'");
  expectIn(refusal("FIELDS x y z\nCOUNT 1 1 5000\nDATA ascii\n"), "field z", "COUNT 5000");
  expectIn(refusal("FIELDS x y z\nWIDTH\nDATA ascii\n"), ":2: ", "WIDTH");
  expectIn(refusal(header("x y z", "4 4 4", "F F F", 1, "packed")), ":11: ", "'packed'");
  expectIn(refusal("FIELDS x y z\nWIDTH 1000000000000\nHEIGHT 1000000000000\nDATA ascii\n"),
           "WIDTH times HEIGHT is too large");
  EXPECT_REFUSED(readPcd(path("no.pcd")), "no.pcd", "No such file");
}

TEST_F(PcdFileTest, RefusesPointsThatAreMissingOrNoNumbers) {
  const std::string ascii = header("x y z", "4 4 4", "F F F", 2, "ascii");
  expectIn(refusal(ascii + "1 2 3\n"), "cut short", "1 points, 2 expected");
  expectIn(refusal(ascii + "1 2 3\n1 2\n"), ":13: ", "2 values, 3 expected");
  expectIn(refusal(ascii + "1 2 3\n1 2 z\n"), ":13: ", "'z'");
  expectIn(refusal(header("x y z", "4 4 4", "F F F", 2, "binary") + floats({1, 2, 3, 4, 5})),
           "cut short", "20 bytes", "2 points of 12 bytes");
}

TEST_F(PcdFileTest, ReadsARealScan) {
  POLEMCL_NEEDS_DATA();
  const Cloud cloud = readPcd(dataFolder() / "os1_64" / "0.pcd");
  EXPECT_EQ(cloud.size() + cloud.invalid, 61700u);
  EXPECT_LT(*std::max_element(cloud.x.begin(), cloud.x.end()), 200);
}

}  // namespace
}  // namespace polemcl::test_pcd_file
