#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

#include "core/extraction/scan_line/ScanLines.h"
#include "core/sensor/PinholeCamera.h"

namespace polemcl::test_pinhole_camera {
namespace {

PinholeCamera camera(double pitch = 0, double roll = 0) {
  PinholeCamera c;
  c.width = 64;
  c.height = 48;
  c.fx = 50;
  c.fy = 55;
  c.cx = 30;
  c.cy = 26;
  c.R_lidar_camera = (Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                      Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                         .toRotationMatrix();
  return c;
}

/// One point for every pixel, at depths that differ, in the order of the pixels.
struct Pixels {
  explicit Pixels(const PinholeCamera& c) {
    for (int row = 0; row < c.height; ++row)
      for (int column = 0; column < c.width; ++column) {
        const double depth = 4 + 0.37 * ((row * 7 + column * 3) % 13);
        const Eigen::Vector3d p =
            c.R_lidar_camera * Eigen::Vector3d(1, (c.cx - column) / c.fx, (c.cy - row) / c.fy);
        x.push_back(static_cast<float>(depth * p.x()));
        y.push_back(static_cast<float>(depth * p.y()));
        z.push_back(static_cast<float>(depth * p.z()));
      }
  }
  PointsView view() const { return {x.data(), y.data(), z.data(), x.size()}; }
  std::vector<float> x, y, z;
};

/// Sorts all pixels into rows. \param line The row a pixel (row, column) belongs to.
template <class Line>
void expectOwnRows(const PinholeCamera& c, int lines, Line line) {
  const Pixels pixels(c);
  const SensorModel model(c);
  ASSERT_EQ(model.beamCount(), lines);
  GroundGrid ground;
  ground.build(pixels.view(), 0.5f, 50, 1.5f);
  ScanLines rows(model);
  const auto& counts = rows.build(pixels.view(), ground, -1000);
  ASSERT_EQ(counts.used, pixels.x.size());
  for (int row = 0; row < lines; ++row) {
    for (const Return* r = rows.begin(row); r < rows.end(row); ++r) {
      const int point = static_cast<int>(r->point);
      ASSERT_EQ(line(point / c.width, point % c.width), row);
      // To the left is to the left in the image, so neighbours are neighbours.
      if (r == rows.begin(row)) continue;
      ASSERT_EQ(std::abs(point - static_cast<int>((r - 1)->point)),
                lines == c.height ? 1 : c.width);
    }
  }
}

TEST(PinholeCamera, EveryPixelGoesToItsRow) {
  const auto ownRow = [](int row, int) { return row; };
  expectOwnRows(camera(), 48, ownRow);
  expectOwnRows(camera(0.17), 48, ownRow);
  expectOwnRows(camera(-0.3, 0.05), 48, ownRow);
}

TEST(PinholeCamera, RowsOfACameraTurnedOverOrOnItsSide) {
  expectOwnRows(camera(0.1, M_PI), 48, [](int row, int) { return 47 - row; });
  expectOwnRows(camera(0, M_PI / 2), 64, [](int, int column) { return column; });
  expectOwnRows(camera(0, -M_PI / 2), 64, [](int, int column) { return 63 - column; });
}

TEST(PinholeCamera, PointsBesideTheImageAndBehindAreOutOfView) {
  const SensorModel model(camera());
  const float x[] = {5, 5, 5, -5}, y[] = {0, 0, 0, 0};
  // Ahead; above the first row; below the last; behind.
  const float z[] = {0, 5 * 26.6f / 55, -5 * 21.6f / 55, 0};
  GroundGrid ground;
  ground.build({x, y, z, 4}, 0.5f, 50, 1.5f);
  ScanLines rows(model);
  const auto& counts = rows.build({x, y, z, 4}, ground, -1000);
  EXPECT_EQ(counts.used, 1u);
  EXPECT_EQ(counts.outOfView, 3u);
  EXPECT_EQ(rows.size(26), 1u);
}

// The plane of a row over a place: the height of a point of that row there.
TEST(PinholeCamera, HeightOfARowOverAPlace) {
  for (const auto& c : {camera(), camera(0.17, 0.05), camera(0.2, M_PI), camera(0.1, M_PI / 2)}) {
    const SensorModel model(c);
    const Pixels pixels(c);
    for (std::size_t i = 0; i < pixels.x.size(); i += 37) {
      const int row = static_cast<int>(i) / c.width, column = static_cast<int>(i) % c.width;
      const int line = model.beamCount() == c.width ? column
                       : c.R_lidar_camera(2, 2) < 0 ? c.height - 1 - row
                                                    : row;
      EXPECT_NEAR(
          model.heightOver(line, pixels.x[i], pixels.y[i], std::hypot(pixels.x[i], pixels.y[i])),
          pixels.z[i], 1e-4);
    }
  }
}

TEST(PinholeCamera, StepsBetweenPixels) {
  const SensorModel model(camera());
  EXPECT_NEAR(model.columnAngle(), std::atan(1 / 50.), 1e-12);
  EXPECT_NEAR(model.spacingAbove(26), std::atan(1 / 55.), 1e-12);
}

TEST(PinholeCamera, RefusesWhatIsNoCamera) {
  const auto refused = [](auto spoil) {
    PinholeCamera c = camera();
    c.validate();
    spoil(c);
    EXPECT_THROW(c.validate(), Error);
    EXPECT_THROW(SensorModel{c}, Error);
  };
  refused([](PinholeCamera& c) { c.fx = 0; });
  refused([](PinholeCamera& c) { c.fx = -1; });
  refused([](PinholeCamera& c) { c.fy = 0; });
  refused([](PinholeCamera& c) { c.fy = std::numeric_limits<double>::infinity(); });
  refused([](PinholeCamera& c) { c.cx = std::nan(""); });
  refused([](PinholeCamera& c) { c.cy = std::nan(""); });
  refused([](PinholeCamera& c) { c.width = 1; });
  refused([](PinholeCamera& c) { c.height = 20000; });
}

}  // namespace
}  // namespace polemcl::test_pinhole_camera
