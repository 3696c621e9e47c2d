#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "report/picture/ScanPicture.h"
#include "support/Pixels.h"

namespace polemcl::report::test_scan_picture {
namespace {

constexpr unsigned orange = 0xd55e00, low = 0xd8dce1, middle = 0x7aa6cf, high = 0x0b4a86,
                   highest = 0x009e73;

/// A patch of ground, a wall above 2 m, and other points.
struct Scan {
  std::vector<float> x, y, z;
  void add(double px, double py, double pz) {
    x.push_back(static_cast<float>(px));
    y.push_back(static_cast<float>(py));
    z.push_back(static_cast<float>(pz));
  }
  /// Points close enough together to fill an area of half a metre.
  void patch(double px, double py, double pz) {
    for (double u = -0.25; u <= 0.25; u += 0.01)
      for (double v = -0.25; v <= 0.25; v += 0.01) add(px + u, py + v, pz);
  }
  ScanView view() const {
    ScanView view;
    view.points = {x.data(), y.data(), z.data(), x.size()};
    view.ground = -2;
    return view;
  }
};

PoleDetection pole(double x, double y) {
  PoleDetection p;
  p.x = x;
  p.y = y;
  p.top = 3;
  return p;
}

class ScanPicture : public ::testing::Test {
 protected:
  std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "scan.png";
};

/// Centre of all pixels of a colour in the plot (800 px wide: frame from 80, 84 to 776, 740).
Eigen::Vector2d centre(const Pixels& image, unsigned color) {
  Eigen::Vector2d sum(0, 0);
  double count = 0;
  for (int y = 86; y < 738; ++y)
    for (int x = 82; x < 774; ++x)
      if (image.at(x, y) == color) {
        sum += Eigen::Vector2d(x, y);
        ++count;
      }
  EXPECT_GT(count, 0) << std::hex << color;
  return sum / count;
}

}  // namespace

TEST_F(ScanPicture, PointsAreColouredByHeightInTheirPlaces) {
  Scan scan;
  scan.patch(6, 3, -1.9);
  scan.patch(-6, 3, -1.5);
  scan.patch(-6, -3, 0.5);
  scan.patch(6, -3, 3);
  scan.add(NAN, 0, 0);
  scan.add(1e6, 0, 0);
  drawScanPng(scan.view(), file, 800);
  const Pixels image(file);
  EXPECT_EQ(image.width(), 800);
  EXPECT_EQ(image.height(), 800);
  const Eigen::Vector2d a = centre(image, low), b = centre(image, middle), c = centre(image, high),
                        d = centre(image, highest);
  // x right, y up, equal scales; 12 m to the nearer border.
  const double metre = (a.x() - b.x()) / 12;
  EXPECT_NEAR(metre, 656.0 / 24, 0.5);
  EXPECT_NEAR(c.y() - b.y(), 6 * metre, 1);
  EXPECT_NEAR(d.x() - c.x(), 12 * metre, 1);
  EXPECT_NEAR(d.y() - a.y(), 6 * metre, 1);
}

TEST_F(ScanPicture, PolesGetRingsAndTheViewGrowsWithThem) {
  Scan scan;
  scan.patch(0, 5, 0.5);
  ScanView view = scan.view();
  drawScanPng(view, file, 800);
  const std::size_t inLegend = Pixels(file).count(orange);
  view.poles = {pole(20, -10)};
  drawScanPng(view, file, 800);
  const Pixels image(file);
  EXPECT_GT(image.count(orange), inLegend);
  const double metre = 656.0 / 46;  // 23 m to the nearer border
  const Eigen::Vector2d at = centre(image, orange);
  EXPECT_NEAR(at.x(), 80 + 348 + 20 * metre, 2);
  EXPECT_NEAR(at.y(), 84 + 328 + 10 * metre, 2);
}

TEST_F(ScanPicture, LabelsStayInsideTheFrame) {
  Scan scan;
  scan.patch(0, 5, 0.5);
  ScanView view = scan.view();
  view.poles = {pole(30, 0)};  // 726 px, 412 px: no room to the right
  drawScanPng(view, file, 800);
  const Pixels image(file);
  const auto darkBetween = [&](int left, int right) {
    int dark = 0;
    for (int y = 402; y < 422; ++y)
      for (int x = left; x < right; ++x) dark += (image.at(x, y) & 0xff) < 0x60;
    return dark;
  };
  EXPECT_EQ(darkBetween(742, 774), 0);
  EXPECT_GT(darkBetween(600, 712), 20);
}

TEST_F(ScanPicture, SameInputSameBytes) {
  Scan scan;
  scan.patch(0, 5, 0.5);
  ScanView view = scan.view();
  view.title = "a scan";
  for (int i = 0; i < 9; ++i) view.poles.push_back(pole(0.3 * i, 2));  // labels that make room
  const auto bytes = [&] {
    drawScanPng(view, file, 800);
    std::ifstream in(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::string first = bytes();
  EXPECT_FALSE(first.empty());
  EXPECT_EQ(first, bytes());
}

TEST_F(ScanPicture, RefusesWhatCannotBeDrawn) {
  Scan scan;
  EXPECT_THROW(drawScanPng(scan.view(), file), Error);
  scan.add(1, 2, 3);
  EXPECT_THROW(drawScanPng(scan.view(), file, 799), Error);
  ScanView view = scan.view();
  view.poles = {pole(NAN, 0)};
  EXPECT_THROW(drawScanPng(view, file), Error);
  EXPECT_THROW(drawScanPng(scan.view(), "/nowhere/scan.png"), Error);
}

}  // namespace polemcl::report::test_scan_picture
