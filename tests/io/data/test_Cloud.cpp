#include <cmath>
#include <limits>

#include <polemcl/io/data/Cloud.h>
#include "support/IoFiles.h"

namespace polemcl::test_cloud {

using namespace polemcl::io;
using namespace polemcl::io::test;

using CloudTest = FolderTest;

TEST_F(CloudTest, ReadsPointsByHand) {
  const Cloud cloud = readKittiBin(write("a.bin", floats({1, 2, 3, 0.25f, -4, 0, 0, 1})));
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_EQ(cloud.x, (std::vector<float>{1, -4}));
  EXPECT_EQ(cloud.y, (std::vector<float>{2, 0}));
  EXPECT_EQ(cloud.z, (std::vector<float>{3, 0}));
  EXPECT_EQ(cloud.intensity, (std::vector<float>{0.25f, 1}));
  EXPECT_EQ(cloud.invalid, 0u);
  const PointsView view = cloud.view();
  EXPECT_EQ(view.size, 2u);
  EXPECT_EQ(view.z[0], 3);
}

TEST_F(CloudTest, DropsAndCountsInvalidPoints) {
  const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
  const Cloud cloud =
      readKittiBin(write("a.bin", floats({nan,  1, 1, 1,   1, inf, 1,     1, 1, 1,
                                          -inf, 1, 0, 0,   0, 1,   -0.0f, 0, 0, 1,  //
                                          5,    6, 7, nan, 0, 0,   1e-3f, 1})));
  EXPECT_EQ(cloud.invalid, 5u);
  EXPECT_EQ(cloud.x, (std::vector<float>{5, 0}));
  EXPECT_EQ(cloud.intensity.size(), 2u);
}

TEST_F(CloudTest, AnEmptyFileIsAnEmptyCloud) {
  const Cloud cloud = readKittiBin(write("a.bin", ""));
  EXPECT_EQ(cloud.size(), 0u);
  EXPECT_EQ(cloud.invalid, 0u);
}

TEST_F(CloudTest, RefusesAFileCutShort) {
  const fs::path file = write("a.bin", floats({1, 2, 3, 4}) + "abc");
  EXPECT_REFUSED(readKittiBin(file), file.string(), "cut short", "19 bytes");
}

TEST_F(CloudTest, RefusesAMissingFile) {
  EXPECT_REFUSED(readKittiBin(path("no.bin")), path("no.bin").string(),
                 "No such file or directory");
}

TEST_F(CloudTest, ReadsARealScan) {
  POLEMCL_NEEDS_DATA();
  const fs::path folder = dataFolder() / "kitti_raw_0005" / "velodyne";
  const fs::path file = fs::directory_iterator(folder)->path();
  const Cloud cloud = readKittiBin(file);
  EXPECT_EQ(cloud.size() + cloud.invalid, fs::file_size(file) / 16);
  EXPECT_GT(cloud.size(), 100000u);
  double farthest = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    farthest = std::max<double>(farthest, std::hypot(cloud.x[i], cloud.y[i]));
  }
  EXPECT_GT(farthest, 50);
  EXPECT_LT(farthest, 130);  // range of the HDL-64E
}

}  // namespace polemcl::test_cloud
