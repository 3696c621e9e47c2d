#include <gtest/gtest.h>

#include <cmath>

#include "report/picture/PlotAxes.h"

namespace polemcl::report::test_plot_axes {

TEST(PlotAxes, TicksIncludeBothEnds) {
  EXPECT_EQ(ticks({-1, 1}, 0.5), (std::vector<double>{-1, -0.5, 0, 0.5, 1}));
  EXPECT_EQ(ticks({0.1, 0.9}, 1), std::vector<double>{});
}

TEST(PlotAxes, ZeroHasNoSign) {
  EXPECT_FALSE(std::signbit(ticks({-0.4, 1}, 0.5).front()));
}

TEST(PlotAxes, LabelsHaveTheDecimalsOfTheStep) {
  EXPECT_EQ(tickLabel(100, 50), "100");
  EXPECT_EQ(tickLabel(0.5, 0.1), "0.5");
  EXPECT_EQ(tickLabel(0.5, 0.05), "0.50");
  EXPECT_EQ(tickLabel(2, 1), "2");
}

TEST(PlotAxes, PixelsGrowDownwardsWhereValuesGrowUpwards) {
  const PlotAxes axes{{10, 20, 200, 100}, {0, 4}, {-1, 1}};
  EXPECT_EQ(axes.toPixel(0, 1), Eigen::Vector2d(10, 20));
  EXPECT_EQ(axes.toPixel(4, -1), Eigen::Vector2d(210, 120));
  EXPECT_EQ(axes.toPixel(1, 0), Eigen::Vector2d(60, 70));
}

TEST(PlotAxes, EqualScalesKeepShapesAndTheMargin) {
  const PlotAxes axes = equalScales({0, 0, 1000, 500}, {0, 90}, {0, 10}, 50);
  EXPECT_NEAR(axes.pixelsPerX(), 10, 1e-9);
  EXPECT_NEAR(axes.frame.height / axes.y.span(), 10, 1e-9);
  EXPECT_NEAR(axes.toPixel(0, 5).x(), 50, 1e-9);
  EXPECT_NEAR(axes.toPixel(90, 5).x(), 950, 1e-9);
  EXPECT_NEAR(axes.toPixel(45, 5).y(), 250, 1e-9);
}

TEST(PlotAxes, ASinglePlaceGetsAMetreAround) {
  const PlotAxes axes = equalScales({0, 0, 300, 300}, {7, 7}, {-2, -2}, 50);
  EXPECT_NEAR(axes.pixelsPerX(), 200, 1e-9);
  EXPECT_NEAR(axes.toPixel(7, -2).x(), 150, 1e-9);
}

}  // namespace polemcl::report::test_plot_axes
