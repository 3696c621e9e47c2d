#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "report/picture/MapPicture.h"
#include "support/Pixels.h"
#include "support/SampleViews.h"

namespace polemcl::report::test_map_picture {
namespace {

constexpr unsigned orange = 0xd55e00, grey = 0xaab2bd, blue = 0x0072b2, green = 0x009e73;

/// Centres of the connected areas of one colour, px.
std::vector<Eigen::Vector2d> blobs(const Pixels& image, unsigned color) {
  std::vector<char> seen(static_cast<std::size_t>(image.width() * image.height()));
  std::vector<Eigen::Vector2d> centres;
  const auto isNew = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < image.width() && y < image.height() &&
           !seen[static_cast<std::size_t>(y * image.width() + x)] && image.at(x, y) == color;
  };
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      if (!isNew(x, y)) continue;
      std::vector<Eigen::Vector2i> open = {{x, y}};
      seen[static_cast<std::size_t>(y * image.width() + x)] = 1;
      Eigen::Vector2d sum(0, 0);
      for (std::size_t i = 0; i < open.size(); ++i) {
        const Eigen::Vector2i at = open[i];
        sum += at.cast<double>();
        for (const auto& step : {Eigen::Vector2i(1, 0), Eigen::Vector2i(-1, 0),
                                 Eigen::Vector2i(0, 1), Eigen::Vector2i(0, -1)})
          if (isNew(at.x() + step.x(), at.y() + step.y())) {
            open.push_back(at + step);
            seen[static_cast<std::size_t>(open.back().y() * image.width() + open.back().x())] = 1;
          }
      }
      centres.push_back(sum / static_cast<double>(open.size()));
    }
  return centres;
}

bool hasColorNear(const Pixels& image, const Eigen::Vector2d& at, unsigned color, int reach = 3) {
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x)
      if (image.at(static_cast<int>(at.x()) + x, static_cast<int>(at.y()) + y) == color)
        return true;
  return false;
}

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST(MapPicture, PolesStandWhereTheMapSaysAndOneMoreInTheLegend) {
  const MapView view = smallDrive();
  const TestFolder folder;
  const auto file = folder / "a.png";
  drawMapPng(view, file, 1300, 800);
  const Pixels image(file);
  EXPECT_EQ(image.width(), 1300);
  EXPECT_EQ(image.height(), 800);
  std::vector<Eigen::Vector2d> discs = blobs(image, orange);
  ASSERT_EQ(discs.size(), view.poles.size() + 1);
  discs.erase(discs.begin());  // the legend is at the top
  std::sort(discs.begin(), discs.end(), [](auto& a, auto& b) { return a.x() < b.x(); });
  // One scale for both axes, y upwards: from the first two poles follow the others.
  const double scale = (discs[1].x() - discs[0].x()) / 6;
  EXPECT_GT(scale, 5);
  for (std::size_t i = 1; i < discs.size(); ++i) {
    EXPECT_NEAR(discs[i].x() - discs[0].x(), scale * (view.poles[i].x - 2), 1);
    EXPECT_NEAR(discs[i].y() - discs[0].y(), -scale * (view.poles[i].y - 6), 1);
  }
}

TEST(MapPicture, TheEstimateLiesBesideTheTruthByItsError) {
  const MapView view = smallDrive(2.0, 0);
  const TestFolder folder;
  const auto file = folder / "a.png";
  drawMapPng(view, file, 1300, 800);
  const Pixels image(file);
  std::vector<Eigen::Vector2d> discs = blobs(image, orange);
  ASSERT_EQ(discs.size(), 5u);
  discs.erase(discs.begin());
  std::sort(discs.begin(), discs.end(), [](auto& a, auto& b) { return a.x() < b.x(); });
  const double scale = (discs[1].x() - discs[0].x()) / 6;
  const Eigen::Vector2d truthAt11 = discs[0] + scale * Eigen::Vector2d(9, 6);
  const Eigen::Vector2d estimateAt11 = truthAt11 - scale * Eigen::Vector2d(0, 2);
  EXPECT_TRUE(hasColorNear(image, truthAt11, grey));
  EXPECT_FALSE(hasColorNear(image, truthAt11, blue));
  EXPECT_TRUE(hasColorNear(image, estimateAt11, blue));
  EXPECT_FALSE(hasColorNear(image, estimateAt11, grey));
}

TEST(MapPicture, ErrorsAreDrawnOnlyWhenThereIsATruth) {
  MapView view = smallDrive();
  const TestFolder folder;
  drawMapPng(view, folder / "with.png");
  view.truth.clear();
  drawMapPng(view, folder / "without.png");
  EXPECT_GT(Pixels(folder / "with.png").count(green), 500u);
  EXPECT_EQ(Pixels(folder / "without.png").count(green), 0u);
  EXPECT_EQ(Pixels(folder / "without.png").count(grey), 0u);
}

TEST(MapPicture, NoLineJoinsTwoDrives) {
  MapView view = smallDrive();
  view.truth.clear();
  view.estimate.clear();
  for (const double y : {0.0, 40.0})  // the second drive begins at the time of the first one
    for (int i = 0; i <= 10; ++i) view.estimate.push_back({0.1 * i, {4.0 * i, y, 0}});
  const TestFolder folder;
  drawMapPng(view, folder / "two.png");
  for (std::size_t i = 0; i < view.estimate.size(); ++i)
    view.estimate[i].time = 0.1 * static_cast<double>(i);
  drawMapPng(view, folder / "one.png");
  const std::size_t two = Pixels(folder / "two.png").count(blue);
  EXPECT_GT(two, 500u);
  EXPECT_LT(static_cast<double>(two),
            0.8 * static_cast<double>(Pixels(folder / "one.png").count(blue)));
}

TEST(MapPicture, AMapAloneIsAPicture) {
  MapView view;
  view.poles = {poleAt(100, 200)};
  const TestFolder folder;
  const auto file = folder / "a.png";
  drawMapPng(view, file);
  const auto discs = blobs(Pixels(file), orange);
  ASSERT_EQ(discs.size(), 2u);
}

TEST(MapPicture, SameInputSameBytes) {
  const TestFolder folder;
  drawMapPng(smallDrive(), folder / "a.png");
  drawMapPng(smallDrive(), folder / "b.png");
  EXPECT_EQ(bytesOf(folder / "a.png"), bytesOf(folder / "b.png"));
}

TEST(MapPicture, RefusesASizeNobodyCanRead) {
  const TestFolder folder;
  const auto file = folder / "a.png";
  EXPECT_THROW(drawMapPng(smallDrive(), file, 1199, 750), Error);
  EXPECT_THROW(drawMapPng(smallDrive(), file, 1200, 749), Error);
  EXPECT_NO_THROW(drawMapPng(smallDrive(), file, 1200, 750));
}

TEST(MapPicture, RefusesNothingAndLeavesNoFile) {
  const TestFolder folder;
  const auto file = folder / "a.png";
  EXPECT_THROW(drawMapPng({}, file), Error);
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(MapPicture, RefusesAnEstimateOfAnotherTime) {
  MapView view = smallDrive();
  for (StampedPose2D& pose : view.estimate) pose.time += 1e6;
  const TestFolder folder;
  const auto file = folder / "a.png";
  EXPECT_THROW(drawMapPng(view, file), Error);
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace polemcl::report::test_map_picture
