#include <algorithm>
#include <limits>

#include "report/batch/Html.h"
#include "report/batch/NumberFormat.h"
#include "report/batch/ReportParts.h"
#include "report/batch/SvgPlot.h"

namespace polemcl::report {
namespace {

constexpr double mapWidth = 480, mapRight = 12, above = 12, below = 46;
constexpr double mapMargin = 14;  // between the content and the frame, pixels
constexpr double leastHeight = 180, mostHeight = 440;

struct Box {
  AxisRange x{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  AxisRange y = x;
  void include(const std::vector<Eigen::Vector2d>& points) {
    for (const Eigen::Vector2d& point : points) {
      x = {std::min(x.low, point.x()), std::max(x.high, point.x())};
      y = {std::min(y.low, point.y()), std::max(y.high, point.y())};
    }
  }
  bool empty() const { return x.low > x.high; }
};

/// Poles far from any path are of other sessions; the plot shows where this one went.
Box boxOf(const SessionPlots& plots) {
  Box box;
  box.include(plots.truth);
  if (box.empty()) box.include(plots.estimate);
  if (box.empty()) box.include(plots.mapPoles);
  if (box.empty()) return box;
  const double rim = std::max(20.0, 0.03 * std::max(box.x.span(), box.y.span()));
  box.x = {box.x.low - rim, box.x.high + rim};
  box.y = {box.y.low - rim, box.y.high + rim};
  return box;
}

/// Room for the title and the labels of the y axis: northings have seven digits.
double leftMargin(const Box& box) {
  const std::size_t digits =
      std::max(metricText(box.y.low, 0).size(), metricText(box.y.high, 0).size());
  return std::max(66.0, 30 + 8.3 * static_cast<double>(digits));
}

double frameHeight(const Box& box, double left) {
  const double inner = mapWidth - left - mapRight - 2 * mapMargin;
  return std::clamp(inner * box.y.span() / box.x.span() + 2 * mapMargin, leastHeight, mostHeight);
}

std::vector<Eigen::Vector2d> mapPixels(const PlotAxes& axes,
                                       const std::vector<Eigen::Vector2d>& points) {
  std::vector<Eigen::Vector2d> result;
  result.reserve(points.size());
  for (const Eigen::Vector2d& point : points) result.push_back(axes.toPixel(point.x(), point.y()));
  return result;
}

std::vector<Eigen::Vector2d> within(const Rect& frame, std::vector<Eigen::Vector2d> points) {
  points.erase(std::remove_if(points.begin(), points.end(),
                              [&](const Eigen::Vector2d& p) {
                                return p.x() < frame.x || p.x() > frame.right() ||
                                       p.y() < frame.y || p.y() > frame.bottom();
                              }),
               points.end());
  return points;
}

/// One distance of grid lines for both axes.
void drawAxes(SvgPlot& plot, const PlotAxes& axes) {
  std::vector<SvgTick> x = roundTicks(axes.x, axes.frame.width, true);
  const double step = x.size() > 1 ? x[1].at - x[0].at : axes.x.span();
  std::vector<SvgTick> y;
  for (double value : ticks(axes.y, step)) y.push_back({value, tickLabel(value, step)});
  plot.axes(axes, x, y, "x (m)", "y (m)");
}

}  // namespace

std::string mapFigure(const BatchResults& results, const SessionResult& result, PlotIds& ids) {
  const SessionPlots& plots = result.plots;
  const Box box = boxOf(plots);
  if (box.empty()) return "";
  const std::string& session = results.sessions[result.session].name;
  const std::string& configuration = results.configurations[result.configuration].name;
  const double left = leftMargin(box), height = frameHeight(box, left);
  const PlotAxes axes =
      equalScales({left, above, mapWidth - left - mapRight, height}, box.x, box.y, mapMargin);
  SvgPlot plot(ids.next(), mapWidth, above + height + below, "Map and paths of " + session,
               "Map poles, true path and the path estimated by run 0 with the setting " +
                   configuration + ", seen from above.");
  drawAxes(plot, axes);
  plot.beginClip(axes.frame);
  plot.line(mapPixels(axes, plots.truth), "truth");
  plot.dots(within(axes.frame, mapPixels(axes, plots.mapPoles)), "poles");
  plot.line(mapPixels(axes, plots.estimate), "estimate");
  if (!plots.truth.empty()) plot.dots(mapPixels(axes, {plots.truth.front()}), "start");
  plot.endClip();
  const std::string poles =
      result.mapPoles > 0 ? ", map of " + countText(result.mapPoles) + " poles" : std::string();
  return element("figure",
                 element("div", "class=\"scroll\"", '\n' + plot.str("plot map")) +
                     element("figcaption",
                             "Setting " + element("em", escaped(configuration)) + poles + '.')) +
         '\n';
}

std::string mapLegend() {
  const auto key = [](const std::string& shape, const std::string& name) {
    return element("li", element("svg", "class=\"key\" viewBox=\"0 0 34 14\" aria-hidden=\"true\"",
                                 shape) +
                             name) +
           '\n';
  };
  return element("ul", "class=\"legend\"",
                 '\n' + key("<path class=\"poles\" d=\"M7 7h0M17 7h0M27 7h0\"/>", "map poles") +
                     key("<path class=\"truth\" d=\"M2 7h30\"/>", "true path") +
                     key("<path class=\"estimate\" d=\"M2 7h30\"/>", "estimate, run 0") +
                     key("<path class=\"start\" d=\"M17 7h0\"/>", "start")) +
         '\n';
}

}  // namespace polemcl::report
