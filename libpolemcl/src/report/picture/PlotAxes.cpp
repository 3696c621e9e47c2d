#include "report/picture/PlotAxes.h"

#include <algorithm>
#include <cmath>

#include "io/file/TextFile.h"

namespace polemcl::report {
namespace {

constexpr Color background = rgb(0xf6f7f9);
constexpr Color gridLine = rgb(0xdfe3e8);
constexpr Color labelColor = rgb(0x5b6470);
constexpr double labelSize = 14;

}  // namespace

std::vector<double> ticks(const AxisRange& range, double step) {
  std::vector<double> values;
  const double first = std::ceil(range.low / step - 1e-9);
  const double last = std::floor(range.high / step + 1e-9);
  for (double i = first; i <= last; ++i) values.push_back(i == 0 ? 0.0 : i * step);
  return values;
}

std::string tickLabel(double value, double step) {
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  return io::fixed(value, decimals);
}

PlotAxes equalScales(const Rect& frame, const AxisRange& x, const AxisRange& y,
                     double marginPixels) {
  const double width = frame.width - 2 * marginPixels, height = frame.height - 2 * marginPixels;
  // A single place still gets a plot: one metre is the smallest content.
  const double metresPerPixel =
      std::max({x.span() / width, y.span() / height, 1.0 / std::min(width, height)});
  const double xHalf = 0.5 * metresPerPixel * frame.width;
  const double yHalf = 0.5 * metresPerPixel * frame.height;
  const double xMiddle = 0.5 * (x.low + x.high), yMiddle = 0.5 * (y.low + y.high);
  return {frame, {xMiddle - xHalf, xMiddle + xHalf}, {yMiddle - yHalf, yMiddle + yHalf}};
}

void drawGrid(Canvas& canvas, const PlotAxes& axes, const GridStyle& style) {
  const Rect& frame = axes.frame;
  canvas.fill(frame, background);
  const auto step = [](const AxisRange& range, double pixels) {
    return tickStep(range.span(), std::max(3, static_cast<int>(pixels)));
  };
  double xStep = step(axes.x, frame.width / 80), yStep = step(axes.y, frame.height / 60);
  if (style.equalSteps) xStep = yStep = std::max(xStep, yStep);
  for (double value : ticks(axes.x, xStep)) {
    const double x = axes.toPixel(value, axes.y.low).x();
    canvas.line({{x, frame.y}, {x, frame.bottom()}}, gridLine, 1);
    if (style.xLabels)
      canvas.text(tickLabel(value, xStep), {x, frame.bottom() + 20},
                  {labelSize, labelColor, Align::centre});
  }
  for (double value : ticks(axes.y, yStep)) {
    const double y = axes.toPixel(axes.x.low, value).y();
    canvas.line({{frame.x, y}, {frame.right(), y}}, gridLine, 1);
    canvas.text(tickLabel(value, yStep), {frame.x - 8, y + 0.35 * labelSize},
                {labelSize, labelColor, Align::right});
  }
  TextStyle title{labelSize + 1, labelColor, Align::centre};
  if (!style.xTitle.empty())
    canvas.text(style.xTitle, {frame.x + frame.width / 2, frame.bottom() + 44}, title);
  title.upwards = true;
  if (!style.yTitle.empty())
    canvas.text(style.yTitle, {frame.x - 62, frame.y + frame.height / 2}, title);
}

}  // namespace polemcl::report
