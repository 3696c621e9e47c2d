#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <cstring>

#include "mrpt/observation/ObservationPoints.h"
#include "support/ExtractionSamples.h"
#include "support/Refusal.h"

namespace polemcl::test_depth_image {
namespace {

using mrpt::obs::CObservation3DRangeScan;
using mrpt::poses::CPose3D;
using namespace samples;

constexpr double kDegree = M_PI / 180;
const std::vector<TestPole> kPoles = {{7, 0.4, 0.10, 4}, {9, -2.5, 0.15, 4}, {12, 3, 0.12, 4}};

/// The ray (x right, y down, at depth 1) that a lens bends to this place, by Newton's method on
/// Brown's model with numerical derivatives.
Eigen::Vector2d undistorted(const Eigen::Vector2d& bent, const std::vector<double>& lens) {
  if (lens.empty()) return bent;
  const auto bend = [&](const Eigen::Vector2d& p) {
    const double r2 = p.squaredNorm(), xy = p.x() * p.y();
    const double radial = 1 + r2 * (lens[0] + r2 * (lens[1] + r2 * lens[4]));
    return Eigen::Vector2d(p.x() * radial + 2 * lens[2] * xy + lens[3] * (r2 + 2 * p.x() * p.x()),
                           p.y() * radial + lens[2] * (r2 + 2 * p.y() * p.y()) + 2 * lens[3] * xy);
  };
  Eigen::Vector2d ray = bent;
  for (int i = 0; i < 10; ++i) {
    constexpr double step = 1e-6;
    Eigen::Matrix2d J;
    J << (bend(ray + Eigen::Vector2d(step, 0)) - bend(ray)) / step,
        (bend(ray + Eigen::Vector2d(0, step)) - bend(ray)) / step;
    ray -= J.inverse() * (bend(ray) - bent);
  }
  return ray;
}

/// Casts a ray through every pixel: poles in front of a wall, on flat ground.
/// \param mount Camera in the robot frame, ground at z = 0.
/// \param lens k1, k2, p1, p2, k3 of a lens that distorts; empty: none.
CObservation3DRangeScan depthImage(const CPose3D& mount, bool rangeIsDepth = true, int height = 480,
                                   int width = 640, const std::vector<double>& lens = {}) {
  CObservation3DRangeScan scan;
  scan.sensorPose = mount;
  scan.hasRangeImage = true;
  scan.range_is_depth = rangeIsDepth;
  scan.rangeUnits = 0.001f;
  scan.cameraParams.setIntrinsicParamsFromValues(525, 520, 0.5 * width - 3, 0.5 * height + 2);
  scan.rangeImage.resize(height, width);
  if (!lens.empty()) {
    scan.cameraParams.distortion = mrpt::img::DistortionModel::plumb_bob;
    scan.cameraParams.setDistortionPlumbBob(lens[0], lens[1], lens[2], lens[3], lens[4]);
  }
  const auto& camera = scan.cameraParams;
  const Eigen::Isometry3d T = isometry(mount);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const Eigen::Vector2d ray = undistorted(
          {(column - camera.cx()) / camera.fx(), (row - camera.cy()) / camera.fy()}, lens);
      Eigen::Vector3d along(1, -ray.x(), -ray.y());
      if (!rangeIsDepth) along.normalize();
      const double depth = castRay(T.translation(), T.linear() * along, kPoles);
      scan.rangeImage(row, column) = static_cast<std::uint16_t>(std::lround(depth * 1000));
    }
  return scan;
}

/// `[sensor]` describes a LiDAR; only its height fits the camera.
ObservationPoleExtractorOptions options() {
  ObservationPoleExtractorOptions o;
  o.sensor.height = 1.5;
  o.extraction.scanLine.maxRange = 30;
  return o;
}

/// The detection nearest to a pole, robot frame.
PoleDetection nearest(const CObservationPoles& scan, const TestPole& pole) {
  PoleDetection best;
  best.x = 1e6;
  for (const auto& p : scan.polesInRobotFrame())
    if (std::hypot(p.x - pole.x, p.y - pole.y) < std::hypot(best.x - pole.x, best.y - pole.y))
      best = p;
  return best;
}

void expectAllPoles(const CPose3D& mount, bool rangeIsDepth = true) {
  ObservationPoleExtractor extraction(options());
  const auto scan = extraction.process(depthImage(mount, rangeIsDepth));
  EXPECT_EQ(scan->poles.size(), kPoles.size());
  EXPECT_EQ(extraction.report().outOfView, 0u);
  for (const auto& pole : kPoles) {
    const PoleDetection p = nearest(*scan, pole);
    EXPECT_LT(std::hypot(p.x - pole.x, p.y - pole.y), 0.02) << pole.x << " " << p.x << " " << p.y;
    EXPECT_NEAR(p.radius, pole.radius, 0.02) << pole.x;
  }
}

TEST(DepthImage, LevelCamera) {
  expectAllPoles(CPose3D(0.5, 0.1, 1.5, 0, 0, 0));
}
/// The poles stand up to 16 deg aside, where this lens moves them by 13 pixels.
TEST(DepthImage, ALensThatDistorts) {
  const std::vector<double> lens{-0.3, 0.1, 0.002, -0.001, -0.01};
  const CPose3D mount(0.5, 0.1, 1.5, 0, 0, 0);
  for (const bool rangeIsDepth : {true, false}) {
    ObservationPoleExtractor extraction(options());
    auto image = depthImage(mount, rangeIsDepth, 480, 640, lens);
    const auto scan = extraction.process(image);
    EXPECT_EQ(scan->poles.size(), kPoles.size());
    for (const auto& pole : kPoles) {
      const PoleDetection p = nearest(*scan, pole);
      EXPECT_LT(std::hypot(p.x - pole.x, p.y - pole.y), 0.03) << pole.x;
      EXPECT_NEAR(p.radius, pole.radius, 0.02) << pole.x;
    }
    // The same object, then a camera without distortion.
    EXPECT_EQ(extraction.process(depthImage(mount, rangeIsDepth))->poles.size(), kPoles.size());
  }
}

TEST(DepthImage, CoefficientsOfALensThatDoesNotDistortAreIgnored) {
  auto scan = depthImage(CPose3D(0.5, 0.1, 1.5, 0, 0, 0));
  ObservationPoleExtractor extraction(options());
  const auto plain = extraction.process(scan)->poles;
  scan.cameraParams.k1(-0.3);
  const auto ignored = extraction.process(scan)->poles;
  ASSERT_EQ(plain.size(), ignored.size());
  EXPECT_EQ(plain[0].x, ignored[0].x);
}

TEST(DepthImage, RangesAlongTheRay) {
  expectAllPoles(CPose3D(0.5, 0.1, 1.5, 0, 0, 0), false);
}
TEST(DepthImage, PitchedDown) {
  expectAllPoles(CPose3D(0, 0, 1.5, 0.05, 10 * kDegree, 0));
}
TEST(DepthImage, Rolled) {
  expectAllPoles(CPose3D(0, 0, 1.5, 0, 0, 3 * kDegree));
}
TEST(DepthImage, PitchedAndRolled) {
  expectAllPoles(CPose3D(0, 0, 1.5, -0.05, 10 * kDegree, 3 * kDegree));
}
TEST(DepthImage, UpsideDown) {
  expectAllPoles(CPose3D(0, 0, 1.5, 0, 0, M_PI));
}
TEST(DepthImage, OnItsSide) {
  expectAllPoles(CPose3D(0, 0, 1.5, 0, 0, M_PI / 2));
  expectAllPoles(CPose3D(0, 0, 1.5, 0, 0, -M_PI / 2));
}

// With the beams of a LiDAR, the same points lose everything outside the fan, and several pixel
// rows merge into one ring.
TEST(DepthImage, SeesMoreOfPolesThanTheBeamsOfALidar) {
  const auto scan = depthImage(CPose3D(0, 0, 1.5, 0, 10 * kDegree, 0));
  ObservationPoleExtractor extraction(options());
  const auto image = extraction.process(scan);
  const auto cloud = extraction.lidarPoints(scan);
  PoleExtractor lidar(options().sensor, options().extraction);  // the default, an HDL-64E
  CObservationPoles beams;
  beams.poles = lidar.extract({cloud.x.data(), cloud.y.data(), cloud.z.data(), cloud.size()});
  EXPECT_EQ(extraction.report().outOfView, 0u);
  EXPECT_GT(lidar.report().outOfView, 1000u);
  for (const auto& pole : kPoles) {
    const PoleDetection asImage = nearest(*image, pole), asBeams = nearest(beams, pole);
    EXPECT_LT(std::hypot(asImage.x - pole.x, asImage.y - pole.y), 0.02);
    EXPECT_GT(asImage.points, asBeams.points);
  }
}

// Rows and borders of the range image follow the lines of pixels, not those of a LiDAR.
TEST(DepthImage, TheRangeImageMethodFitsTheCamera) {
  auto o = options();
  o.extraction.method = ExtractionMethod::rangeImage;
  for (const double pitch : {0.0, 8.0, -8.0}) {
    ObservationPoleExtractor extraction(o);
    const auto scan = extraction.process(depthImage(CPose3D(0, 0, 1.5, 0, pitch * kDegree, 0)));
    EXPECT_EQ(scan->poles.size(), kPoles.size()) << pitch;
    for (const auto& pole : kPoles) {
      const PoleDetection found = nearest(*scan, pole);
      EXPECT_LT(std::hypot(found.x - pole.x, found.y - pole.y), 0.1) << pitch;
    }
  }
}

TEST(DepthImage, CountsPixelsWithoutDepth) {
  auto scan = depthImage(CPose3D(0, 0, 1.5, 0, 0, 0));
  std::size_t empty = 0;
  for (int row = 0; row < 480; ++row)
    for (int column = 0; column < 640; ++column) {
      if (row % 7 == 3 || (row + column) % 11 == 0) scan.rangeImage(row, column) = 0;
      empty += scan.rangeImage(row, column) == 0;
    }
  ObservationPoleExtractor extraction(options());
  const auto poles = extraction.process(scan);
  EXPECT_EQ(extraction.report().points, 640u * 480u);
  EXPECT_EQ(extraction.report().invalid, empty);
  EXPECT_EQ(poles->poles.size(), kPoles.size());
}

// MRPT reads flags as bytes: those of a damaged rawlog may be neither 0 nor 1.
TEST(DepthImage, FlagsOfAnyByte) {
  auto scan = depthImage(CPose3D(0, 0, 1.5, 0, 0, 0));
  for (bool* flag : {&scan.hasRangeImage, &scan.range_is_depth, &scan.hasPoints3D})
    std::memset(flag, 0x42, sizeof *flag);
  ObservationPoleExtractor extraction(options());
  EXPECT_EQ(extraction.process(scan)->poles.size(), kPoles.size());
}

TEST(DepthImage, StorageFlagsOfAnyByte) {
  struct Damaged : CObservation3DRangeScan {
    Damaged() {
      std::memset(&m_points3D_external_stored, 50, sizeof m_points3D_external_stored);
      m_points3D_external_file = "no_such_cloud.bin";
      hasPoints3D = true;
    }
  };
  ObservationPoleExtractor extraction(options());
  EXPECT_REFUSED(extraction.process(Damaged()), "no_such_cloud.bin");
}

TEST(DepthImage, RefusesNamesOfFilesThatMrptCannotUse) {
  struct Damaged : CObservation3DRangeScan {
    Damaged() {
      m_rangeImage_external_stored = true;
      m_rangeImage_external_file = "x";
    }
  };
  ObservationPoints points{SensorOptions()};
  EXPECT_REFUSED(points.read(Damaged()), "CObservation3DRangeScan cannot be read");
}

TEST(DepthImage, ImagesOfAnySize) {
  ObservationPoleExtractor extraction(options());
  for (const auto& [height, width] : {std::pair{2, 2}, {3, 500}, {301, 417}, {480, 640}}) {
    const auto poles =
        extraction.process(depthImage(CPose3D(0, 0, 1.5, 0, 0, 0), true, height, width));
    EXPECT_EQ(extraction.report().points, static_cast<std::size_t>(height) * width);
    if (height > 300) {
      EXPECT_GE(poles->poles.size(), 2u);
    } else {
      EXPECT_TRUE(poles->poles.empty());
    }
  }
  CObservation3DRangeScan empty;
  EXPECT_TRUE(extraction.process(empty)->poles.empty());
  auto blank = depthImage(CPose3D(), true, 20, 30);
  blank.rangeImage.fill(0);
  EXPECT_TRUE(extraction.process(blank)->poles.empty());
  EXPECT_EQ(extraction.report().invalid, 600u);
}

std::string refusalOf(const CObservation3DRangeScan& scan) {
  ObservationPoleExtractor extraction(options());
  return tests::messageOf([&] { extraction.process(scan); });
}

TEST(DepthImage, RefusesBadIntrinsics) {
  const auto good = depthImage(CPose3D(), true, 20, 30);
  EXPECT_EQ(refusalOf(good), "no error");
  for (const double bad : {0.0, -525.0, std::nan("")}) {
    auto scan = good;
    scan.cameraParams.fx(bad);
    EXPECT_HAS(refusalOf(scan), "fx");
    scan = good;
    scan.cameraParams.fy(bad);
    EXPECT_HAS(refusalOf(scan), "fy");
  }
  auto scan = good;
  scan.cameraParams.cx(INFINITY);
  EXPECT_HAS(refusalOf(scan), "principal point");
  scan = good;
  scan.rangeUnits = 0;
  EXPECT_HAS(refusalOf(scan), "rangeUnits");
  EXPECT_HAS(refusalOf(depthImage(CPose3D(), true, 1, 30)), "30 x 1");
}

TEST(DepthImage, RefusesLensesThatItCannotUndistort) {
  auto scan = depthImage(CPose3D(), true, 20, 30);
  scan.cameraParams.distortion = mrpt::img::DistortionModel::kannala_brandt;
  EXPECT_HAS(refusalOf(scan), "distortion is kannala_brandt: allowed are");
  scan.cameraParams.distortion = mrpt::img::DistortionModel::plumb_bob;
  scan.cameraParams.k5(0.1);
  EXPECT_HAS(refusalOf(scan), "plumb_bob with k4, k5, k6: allowed");
}

}  // namespace
}  // namespace polemcl::test_depth_image
