// Visibility ranges converted from the LiDAR frame to the robot frame: mountings rotate and
// shift them.

#include <algorithm>

#include "support/ExtractionSamples.h"

namespace polemcl::test_visibility_range_frames {
namespace {
using mrpt::poses::CPose3D;
using namespace samples;

/// Number of sectors whose ranges differ by more metres than that.
std::size_t differing(const std::vector<float>& a, const std::vector<float>& b, double most) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += std::abs(a[i] - b[i]) > most;
  return count;
}

TEST(VisibilityRangeFrames, LevelCloudsKeepThoseOfTheExtractor) {
  const auto options = hdl32(1.5);
  const TestCloud cloud = plainCloud(options);
  ObservationPoleExtractor extraction(options);
  const auto scan = extraction.process(*observationOf(cloud, CPose3D(0.5, 0.2, 1.5, 0.7, 0, 0)));
  PoleExtractor extractor(options.sensor, options.extraction);
  extractor.extract({cloud.x.data(), cloud.y.data(), cloud.z.data(), cloud.x.size()});
  ASSERT_EQ(scan->visibilityRange.size(), 256u);
  EXPECT_EQ(scan->visibilityRange, extractor.visibilityRange());
  EXPECT_LT(*std::min_element(scan->visibilityRange.begin(), scan->visibilityRange.end()), 20)
      << "poles";
  EXPECT_GE(*std::max_element(scan->visibilityRange.begin(), scan->visibilityRange.end()), 29)
      << "its walls";
}

TEST(VisibilityRangeFrames, ABodyFrameWithZDownIsTurnedBack) {
  auto options = hdl32(1.5);
  const TestCloud cloud = plainCloud(options);
  ObservationPoleExtractor level(options);
  const auto upright = level.process(*observationOf(cloud, CPose3D(0, 0, 1.5, 0, 0, 0)));
  // The same beams in the frame of an upside-down sensor: x forward, y right, z down.
  Eigen::Isometry3d T_cloud_lidar = Eigen::Isometry3d::Identity();
  T_cloud_lidar.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()).toRotationMatrix();
  ObservationPoleExtractor hanging(options);
  const auto down =
      hanging.process(*observationOf(cloud, CPose3D(0, 0, 1.5, 0, 0, M_PI), T_cloud_lidar));
  ASSERT_EQ(down->visibilityRange.size(), 256u);
  EXPECT_LE(differing(upright->visibilityRange, down->visibilityRange, 1e-6), 12u)
      << "edges of sectors";
}

TEST(VisibilityRangeFrames, ALittleTiltChangesLittle) {
  const auto options = hdl32(1.5);
  const auto rangeOf = [&](const CPose3D& pose) {
    ObservationPoleExtractor extraction(options);
    const TestCloud cloud = castScan(options.sensor, isometry(pose), {{-3, 8, 4, 5}});  // a tower
    return extraction.process(*observationOf(cloud, pose))->visibilityRange;
  };
  const auto level = rangeOf(CPose3D(0, 0, 1.5, 0, 0, 0));
  const auto tilted = rangeOf(CPose3D(0, 0, 1.5, 0, mrpt::DEG2RAD(0.2), 0));
  EXPECT_LE(differing(level, tilted, 1), 4u);
}

TEST(VisibilityRangeFrames, RawlogsKeepThem) {
  auto options = hdl32(1.5);
  ObservationPoleExtractor extraction(options);
  const auto scan = extraction.process(*observationOf(plainCloud(options), CPose3D()));
  const auto read =
      std::dynamic_pointer_cast<CObservationPoles>(samples::objectFrom(samples::bytesOf(*scan)));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->visibilityRange, scan->visibilityRange);
}

}  // namespace
}  // namespace polemcl::test_visibility_range_frames
