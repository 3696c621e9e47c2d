#include <gtest/gtest.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cmath>
#include <limits>

#include "report/scene/LiveMoment.h"

namespace polemcl::report::test_scan_points {
namespace {
using Cloud = mrpt::obs::CObservationPointCloud;

Cloud::Ptr cloudOf(const std::string& label, const mrpt::poses::CPose3D& pose) {
  auto cloud = Cloud::Create();
  cloud->sensorLabel = label;
  cloud->sensorPose = pose;
  cloud->pointcloud = mrpt::maps::CSimplePointsMap::Create();
  return cloud;
}

TEST(ScanPoints, AreThoseOfAllLidarsInTheRobotFrame) {
  const auto front = cloudOf("front", {1, 0, 2, M_PI / 2, 0, 0}), rear = cloudOf("rear", {});
  front->pointcloud->insertPoint(3, 0, 0.5f);
  front->pointcloud->insertPoint(0, 0, 0);  // no return
  front->pointcloud->insertPoint(std::numeric_limits<float>::quiet_NaN(), 0, 0);
  rear->pointcloud->insertPoint(1, 2, 3);
  SequenceOptions reading;
  reading.vehicle.lidars.push_back({"rear", {}, {}, {-10, 0, 0, 0, 0, 0}});
  const auto points = scanPoints({front, rear}, reading);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_NEAR(points[0].x, 1, 1e-6);
  EXPECT_NEAR(points[0].y, 3, 1e-6);
  EXPECT_NEAR(points[0].z, 2.5, 1e-6);
  EXPECT_NEAR(points[1].x, -9, 1e-6);  // the settings know better where it is
  EXPECT_NEAR(points[1].y, 2, 1e-6);
  EXPECT_TRUE(scanPoints({}, reading).empty());
}

TEST(ScanPoints, AreThinned) {
  const auto cloud = cloudOf("lidar", {});
  for (int i = 1; i <= 200000; ++i) cloud->pointcloud->insertPoint(static_cast<float>(i), 0, 0);
  const auto points = scanPoints({cloud}, {});
  ASSERT_EQ(points.size(), 50000u);
  for (const std::size_t k : {0u, 1u, 49999u})
    EXPECT_EQ(points[k].x, static_cast<float>(4 * k + 1)) << k;
}

}  // namespace
}  // namespace polemcl::report::test_scan_points
