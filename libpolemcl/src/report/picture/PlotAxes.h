#pragma once
/// \file PlotAxes.h
/// \brief Coordinate axes of a plot: from values to pixels, round ticks, grid and labels.

#include <string>
#include <vector>

#include "core/common/TickStep.h"
#include "report/picture/Canvas.h"

namespace polemcl::report {

/// \brief A range of values, low < high.
struct AxisRange {
  double low = 0, high = 1;
  double span() const { return high - low; }
};

/// \brief The multiples of `step` within the range, ends included (to a rounding error).
std::vector<double> ticks(const AxisRange& range, double step);
/// \brief A tick as text, with the decimals its step needs: (0.5, 0.25) -> "0.50".
std::string tickLabel(double value, double step);

/// \brief A rectangle on a canvas with a range of values along each side; y grows upwards.
struct PlotAxes {
  Rect frame;
  AxisRange x, y;

  Eigen::Vector2d toPixel(double xValue, double yValue) const {
    return {frame.x + (xValue - x.low) / x.span() * frame.width,
            frame.bottom() - (yValue - y.low) / y.span() * frame.height};
  }
  double pixelsPerX() const { return frame.width / x.span(); }
};

/// \brief Axes with equal scales that show all of `content` with a margin, centred in the frame.
PlotAxes equalScales(const Rect& frame, const AxisRange& x, const AxisRange& y,
                     double marginPixels);

/// \brief Which labels drawGrid() writes; empty titles are left out.
struct GridStyle {
  std::string xTitle, yTitle;
  bool xLabels = true;
  bool equalSteps = false;  ///< one distance of grid lines for both axes
};
/// \brief Background, grid lines, tick labels and titles of the axes.
void drawGrid(Canvas& canvas, const PlotAxes& axes, const GridStyle& style);

}  // namespace polemcl::report
