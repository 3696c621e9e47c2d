#include <cmath>

#include "io/dataset/LabelledScans.h"
#include "support/IoFiles.h"

namespace polemcl::test_labelled_scans {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;

std::string labels(std::initializer_list<std::uint32_t> values) {
  std::string bytes(4 * values.size(), '\0');
  std::memcpy(bytes.data(), values.begin(), bytes.size());
  return bytes;
}

class LabelledScansTest : public FolderTest {
 protected:
  std::string refusal(const std::string& poles) const {
    const fs::path file = write("poles_gt.csv", poles);
    return messageOf([&] { readWorldPoles(file); });
  }
};

TEST_F(LabelledScansTest, LabelsStayWithTheirPoints) {
  const auto scan = readLabelledCloud(
      write("a.bin", floats({1, 2, 3, 0.5f, NAN, 0, 0, 0, 0, 0, 0, 1, 4, 5, 6, 0.25f})),
      write("a.label", labels({7, 8, 9, 0x80000001u})));
  EXPECT_EQ(scan.cloud.x, (std::vector<float>{1, 4}));
  EXPECT_EQ(scan.cloud.y, (std::vector<float>{2, 5}));
  EXPECT_EQ(scan.cloud.z, (std::vector<float>{3, 6}));
  EXPECT_EQ(scan.cloud.intensity, (std::vector<float>{0.5f, 0.25f}));
  EXPECT_EQ(scan.cloud.invalid, 2u);
  EXPECT_EQ(scan.labels, (std::vector<std::uint32_t>{7, 0x80000001u}));
}

TEST_F(LabelledScansTest, LabelsLieBesideTheScans) {
  EXPECT_EQ(labelFile("/d/velodyne/000012.bin"), "/d/labels/000012.label");
  EXPECT_EQ(labelFile("velodyne/1.bin"), fs::absolute("labels/1.label"));
}

TEST_F(LabelledScansTest, RefusesLabelsOfAnotherScan) {
  const fs::path bin = write("a.bin", floats({1, 2, 3, 4, 5, 6, 7, 8}));
  for (const std::string& bytes : {labels({1}), labels({1, 2, 3}), labels({1, 2}) + "x"}) {
    const fs::path label = write("a.label", bytes);
    EXPECT_REFUSED(readLabelledCloud(bin, label), label.string(), bin.string());
  }
  EXPECT_REFUSED(readLabelledCloud(bin, path("no.label")), "no.label");
  // A truncated cloud is rejected with any labels.
  const fs::path cut = write("b.bin", floats({1, 2, 3, 4, 5}));
  EXPECT_REFUSED(readLabelledCloud(cut, write("b.label", labels({1}))), cut.string(), "20 bytes");
}

TEST_F(LabelledScansTest, ReadsTruePoles) {
  const auto poles = readWorldPoles(write("poles_gt.csv",
                                          "id,x,y,radius,top,kind\n3,1.5,-2,0.1,5.25,lamp post\n"
                                          "4294967295,0,0,0.05,2,sign\n"));
  ASSERT_EQ(poles.size(), 2u);
  EXPECT_EQ(poles[0].id, 3u);
  EXPECT_EQ(poles[0].x, 1.5);
  EXPECT_EQ(poles[0].y, -2);
  EXPECT_EQ(poles[0].radius, 0.1);
  EXPECT_EQ(poles[0].top, 5.25);
  EXPECT_EQ(poles[1].id, 4294967295u);
}

TEST_F(LabelledScansTest, RefusesPolesWithoutAnId) {
  expectIn(refusal("x,y,radius,top\n1,2,3,4\n"), "column named id");
  for (const char* id : {"-1", "1.5", "4294967296"})
    expectIn(refusal("id,x,y,radius,top\n" + std::string(id) + ",1,2,3,4\n"), ":2: ", "whole");
}

}  // namespace
}  // namespace polemcl::test_labelled_scans
