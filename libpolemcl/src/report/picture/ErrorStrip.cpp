#include "report/picture/ErrorStrip.h"

#include <algorithm>
#include <cmath>

#include "core/common/Statistics.h"
#include "io/file/TextFile.h"

namespace polemcl::report {
namespace {

void drawSeries(Canvas& canvas, const PlotAxes& axes, const ErrorSeries& series,
                const Color& color) {
  std::vector<Eigen::Vector2d> curve;
  for (std::size_t i = 0; i < series.values.size(); ++i)
    curve.push_back(axes.toPixel(series.distance[i], series.values[i]));
  std::vector<Eigen::Vector2d> area = curve;
  area.push_back(axes.toPixel(series.distance.back(), 0));
  area.push_back(axes.toPixel(series.distance.front(), 0));
  Color light = color;
  light.alpha = 0.18;
  canvas.clip(axes.frame);
  canvas.polygon(area, light);
  canvas.line(curve, color, 1.8);
  const double mean = axes.toPixel(0, series.mean).y();
  canvas.line({{axes.frame.x, mean}, {axes.frame.right(), mean}}, rgb(0x30363d), 1.4, true);
  canvas.unclip();
}

void drawNote(Canvas& canvas, const PlotAxes& axes, const ErrorSeries& series) {
  const auto highest = std::max_element(series.values.begin(), series.values.end());
  const std::size_t index = static_cast<std::size_t>(highest - series.values.begin());
  std::string note = series.name + " error: mean " + io::significant(series.mean, 3) + series.unit +
                     ", largest " + io::significant(*highest, 3) + series.unit;
  if (*highest > axes.y.high)
    note += " (above the strip, at " + io::fixed(series.distance[index], 0) + " m)";
  canvas.text(note, {axes.frame.right(), axes.frame.y - 8}, {14, rgb(0x30363d), Align::right});
}

}  // namespace

std::vector<double> distanceDriven(const std::vector<StampedPose2D>& truth,
                                   const std::vector<PoseError>& errors) {
  std::vector<double> along(truth.size(), 0.0);
  for (std::size_t i = 1; i < truth.size(); ++i)
    along[i] = along[i - 1] + std::hypot(truth[i].pose.x - truth[i - 1].pose.x,
                                         truth[i].pose.y - truth[i - 1].pose.y);
  std::vector<double> distances;
  for (const PoseError& error : errors) {
    const auto later =
        std::lower_bound(truth.begin(), truth.end(), error.time,
                         [](const StampedPose2D& pose, double time) { return pose.time < time; });
    const std::size_t i = static_cast<std::size_t>(later - truth.begin());
    if (i == 0 || i == truth.size()) {
      distances.push_back(i == 0 ? 0 : along.back());
      continue;
    }
    const double share = (error.time - truth[i - 1].time) / (truth[i].time - truth[i - 1].time);
    distances.push_back(along[i - 1] + share * (along[i] - along[i - 1]));
  }
  return distances;
}

double valueLimit(const std::vector<double>& values) {
  const double largest = *std::max_element(values.begin(), values.end());
  return std::max(1.1 * std::min(largest, 2 * nearestRank(values, 0.95)), 1e-3);
}

void drawErrorStrip(Canvas& canvas, const Rect& frame, const ErrorSeries& series,
                    const Color& color, bool withDistances) {
  const double length = std::max(series.distance.back() - series.distance.front(), 1.0);
  const PlotAxes axes{frame,
                      {series.distance.front(), series.distance.front() + length},
                      {0, valueLimit(series.values)}};
  drawGrid(canvas, axes, {withDistances ? "distance driven (m)" : "", series.title, withDistances});
  drawSeries(canvas, axes, series, color);
  drawNote(canvas, axes, series);
  canvas.outline(frame, rgb(0xb8bfc8), 1);
}

}  // namespace polemcl::report
