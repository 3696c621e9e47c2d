// That the pictures show what they are given, where it is. test_draw.py tests their looks.

#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>

#include <cmath>

#include <polemcl/core/extraction/PoleExtractor.h>
#include "io/file/Bytes.h"
#include "report/picture/Pictures.h"
#include "support/KnownScene.h"
#include "support/Refusal.h"
#include "support/SampleViews.h"

namespace polemcl::report::test_pictures {
namespace {
constexpr unsigned orange = 0xd55e00, grey = 0xaab2bd, blue = 0x0072b2, green = 0x009e73,
                   lightBlue = 0x7aa6cf, navy = 0x0b4a86, noReturn = 0xf3f4f6;

/// A PNG read with MRPT's image class, which is independent of the writer.
class Pixels {
 public:
  explicit Pixels(const std::filesystem::path& file) {
    if (!m_image.loadFromFile(file.string()))
      throw std::runtime_error("no image: " + file.string());
  }
  int width() const { return static_cast<int>(m_image.getWidth()); }
  int height() const { return static_cast<int>(m_image.getHeight()); }
  /// 0xRRGGBB.
  unsigned at(int x, int y) const {
    const auto column = static_cast<unsigned>(x), row = static_cast<unsigned>(y);
    const auto channel = [&](int c) {
      return static_cast<unsigned>(m_image.at<std::uint8_t>(column, row, static_cast<int8_t>(c)));
    };
    return channel(2) << 16 | channel(1) << 8 | channel(0);  // stored as BGR
  }
  std::size_t count(unsigned color) const {
    std::size_t pixels = 0;
    for (int y = 0; y < height(); ++y)
      for (int x = 0; x < width(); ++x) pixels += at(x, y) == color;
    return pixels;
  }

 private:
  mrpt::img::CImage m_image;
};

/// Left, upper, right and lower end of a part of a picture, px.
struct Part {
  int left, top, right, bottom;
};

/// Centre of the pixels of a colour in a part.
Eigen::Vector2d centre(const Pixels& image, const Part& part, unsigned color) {
  Eigen::Vector2d sum(0, 0);
  double count = 0;
  for (int y = part.top; y < part.bottom; ++y)
    for (int x = part.left; x < part.right; ++x)
      if (image.at(x, y) == color) {
        sum += Eigen::Vector2d(x, y);
        ++count;
      }
  EXPECT_GT(count, 0) << std::hex << color;
  return sum / std::max(count, 1.0);
}

class Pictures : public ::testing::Test {
 protected:
  Pixels map(const MapView& view) const {
    drawMapPng(view, file);
    return Pixels(file);
  }
  testing_apps::TempFolder folder;
  std::filesystem::path file = folder / "a.png";
};

/// Points close enough together to fill an area of half a metre.
void addPatch(clouds::PointList& points, double x, double y, double z) {
  for (double u = -0.25; u <= 0.25; u += 0.01)
    for (double v = -0.25; v <= 0.25; v += 0.01) points.add(x + u, y + v, z);
}

TEST_F(Pictures, AMapShowsPolesTruthAndEstimateWhereTheyAre) {
  MapView view = smallDrive(1);  // the estimate 1 m to the left of the truth
  view.poles = {poleAt(2, 2), poleAt(18, -2)};
  for (std::size_t i = 0; i < view.estimate.size(); i += 2) view.estimate[i].pose.yaw = 0;
  const Pixels image = map(view);
  EXPECT_EQ(image.width(), 1600);
  EXPECT_EQ(image.height(), 1000);
  // The street is long, so the errors are below the map: the map ends above 560 px.
  const Eigen::Vector2d a = centre(image, {92, 96, 800, 560}, orange),
                        b = centre(image, {800, 96, 1568, 560}, orange);
  const double metre = (b.x() - a.x()) / 16;
  EXPECT_NEAR(b.y() - a.y(), 4 * metre, 1) << "equal scales, y upwards";
  const int column = static_cast<int>(a.x() + 9 * metre), row = static_cast<int>(a.y() + 2 * metre),
            higher = row - static_cast<int>(metre);
  EXPECT_EQ(image.at(column, row), grey);
  EXPECT_EQ(image.at(column, higher), blue);
  EXPECT_GT(image.count(green), 500u) << "errors of heading";
}

TEST_F(Pictures, AMapWithoutTruthHasNoErrorsAndNoLineJoinsItsDrives) {
  MapView view = smallDrive();
  view.truth.clear();
  view.estimate.clear();
  view.loops = {{{0, 0}, {0, 40}}};
  for (const double y : {0.0, 40.0})  // the second drive begins at the time of the first one
    for (int i = 0; i <= 10; ++i) view.estimate.push_back({0.1 * i, {4.0 * i, y, 0}});
  const Pixels two = map(view);
  EXPECT_EQ(two.count(green), 0u);
  EXPECT_EQ(two.count(grey), 0u);
  EXPECT_GT(two.count(0xcc79a7), 500u) << "a loop";
  for (std::size_t i = 0; i < view.estimate.size(); ++i)
    view.estimate[i].time = 0.1 * static_cast<double>(i);
  EXPECT_GT(map(view).count(blue), two.count(blue) + 500);
}

TEST_F(Pictures, EachKindOfChangeHasItsColour) {
  const auto diff = [&](const std::vector<MapPole>& later) {
    drawDiffPng(diffMaps({poleAt(0, 0), poleAt(10, 0), poleAt(20, 8)}, later), "a → b", file);
    return Pixels(file);
  };
  const Pixels image = diff({poleAt(0, 0), poleAt(11, 0.5), poleAt(30, 4)});
  const Pixels calm = diff({poleAt(0, 0), poleAt(10, 0), poleAt(20, 8)});
  for (const unsigned color : {green, orange, blue})
    EXPECT_GT(image.count(color), calm.count(color) + 20) << std::hex << color;
  EXPECT_GT(calm.count(grey), image.count(grey)) << "three stayed, not one";
}

TEST_F(Pictures, AScanShowsPointsByHeightAndRingsRoundPoles) {
  clouds::PointList points;
  addPatch(points, -6, 3, -1.5);
  addPatch(points, 6, -3, 1);
  points.add(NAN, 0, 0);
  points.add(1e6, 0, 0);
  PoleDetection pole;
  pole.x = 20;
  pole.y = -10;
  pole.top = 3;
  drawScanPng({"a scan", points.view(), -2, {pole}}, file);
  const Pixels image(file);
  EXPECT_EQ(image.width(), 1500);
  EXPECT_EQ(image.height(), 1500);
  const Part frame{82, 86, 1474, 1438};
  const Eigen::Vector2d low = centre(image, frame, lightBlue), high = centre(image, frame, navy),
                        ring = centre(image, frame, orange);
  const double metre = 1356 / 46.0;  // 23 m to the nearer border
  EXPECT_NEAR(high.x() - low.x(), 12 * metre, 1);
  EXPECT_NEAR(high.y() - low.y(), 6 * metre, 1);
  EXPECT_NEAR(ring.x() - high.x(), 14 * metre, 2);
  EXPECT_NEAR(ring.y() - high.y(), 7 * metre, 2);
}

TEST_F(Pictures, ARangeImageShowsNearAndFarAndMarksPolesInItsThirdCopy) {
  constexpr int left = 24, top = 92, height = 192, step = height + 44, cell = 3;
  constexpr double degree = M_PI / 180;
  const clouds::PointList points = clouds::castYard(clouds::sensorOptions("os1_64"));
  RangeImageView view{"the yard", points.view(), clouds::sensorOptions("os1_64"), {}};
  view.options.fovUp = 17 * degree;
  view.options.fovDown = -17 * degree;
  drawRangeImagePng(view, file);
  const Pixels image(file);
  ASSERT_EQ(image.width(), 1500 + 2 * left);
  ExtractionOptions options;
  options.method = ExtractionMethod::rangeImage;
  options.rangeImage = view.options;
  const auto poles = PoleExtractor(view.sensor, options).extract(points.view());
  ASSERT_EQ(poles.size(), 4u);
  const auto count = [&](int from, int to, int copy) {
    int found = 0;
    for (int x = std::max(left, from); x < std::min(left + 1500, to); ++x)
      for (int y = top + copy * step; y < top + copy * step + height; ++y)
        found += image.at(x, y) == orange;
    return found;
  };
  EXPECT_EQ(count(left, left + 1500, 0) + count(left, left + 1500, 1), 0);
  for (const PoleDetection& pole : poles) {
    // Column of Eq. 1, and a pole's width to each side.
    const double column = 0.5 * (1 - std::atan2(pole.y, pole.x) / M_PI) * 500;
    const int from = left + cell * static_cast<int>(column - 4);
    EXPECT_GE(count(from, from + 8 * cell, 2), 4 * cell * cell) << pole.x << ' ' << pole.y;
  }
  clouds::PointList two;
  for (int i = -20; i <= 20; ++i) {
    two.add(5, i * 0.05, 0);
    two.add(-40, i * 0.4, 0);
  }
  view.points = two.view();
  drawRangeImagePng(view, file);
  const Pixels other(file);
  const auto darkest = [&](int x) {
    unsigned least = 0xff;
    for (int y = top + height / 2 - 6; y < top + height / 2 + 6; ++y)
      least = std::min(least, other.at(x, y) & 0xff);
    return least;
  };
  EXPECT_LT(darkest(left + 750), 0x90u) << "near, ahead";
  EXPECT_GT(darkest(left + 4), 0xa0u) << "far, behind";
  EXPECT_EQ(other.at(left + 375, top + height / 2), noReturn);
}

TEST_F(Pictures, SameInputSameBytesAndNoTextStopsThem) {
  MapView view = smallDrive();
  view.title = "$x_1^$ \xff\n{}";  // no formula, no UTF-8, no line
  drawMapPng(view, file);
  const std::string first = io::readBytes(file);
  drawMapPng(view, file);
  EXPECT_EQ(first, io::readBytes(file));
}

TEST_F(Pictures, RefuseWhatCannotBeDrawnAndLeaveNoFile) {
  MapView late = smallDrive(), broken = smallDrive();
  for (StampedPose2D& pose : late.estimate) pose.time += 1e6;
  broken.poles[1].x = NAN;
  clouds::PointList points;
  points.add(1, 2, 3);
  PoleDetection pole;
  pole.x = NAN;
  RangeImageView image{"", points.view(), {}, {}};
  image.options.epsilon = -1;
  EXPECT_REFUSED(drawMapPng({}, file), "nothing to show");
  EXPECT_REFUSED(drawMapPng(late, file), "belong together");
  EXPECT_REFUSED(drawMapPng(broken, file), "pole 1", "not finite");
  EXPECT_REFUSED(drawDiffPng({}, "", file), "nothing to show");
  EXPECT_REFUSED(drawScanPng({}, file), "a.png", "without points");
  EXPECT_REFUSED(drawScanPng({"", points.view(), 0, {pole}}, file), "not finite");
  EXPECT_REFUSED(drawRangeImagePng({}, file), "a.png", "without points");
  EXPECT_REFUSED(drawRangeImagePng(image, file), "epsilon");
  EXPECT_REFUSED(drawMapPng(smallDrive(), folder / "no/a.png"), "cannot write", "a.png");
  EXPECT_TRUE(std::filesystem::is_empty(file.parent_path()));
}

}  // namespace
}  // namespace polemcl::report::test_pictures
