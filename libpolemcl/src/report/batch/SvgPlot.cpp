#include "report/batch/SvgPlot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/batch/Html.h"
#include "report/batch/NumberFormat.h"

namespace polemcl::report {
namespace {

constexpr double svgLabelSize = 13;
constexpr double characterWidth = 8.3;  // of a digit in a wide sans serif

/// A tenth of a pixel is enough: "12.3", "12", "-0.4".
std::string px(double value) {
  std::string text = metricText(value, 1, "0");
  if (text.size() > 2 && text.substr(text.size() - 2) == ".0") text.resize(text.size() - 2);
  return text;
}

std::string at(const Eigen::Vector2d& point) {
  return px(point.x()) + ' ' + px(point.y());
}

std::string path(const std::string& d, const std::string& className) {
  return "<path class=\"" + className + "\" d=\"" + d + "\"/>\n";
}

std::string pathThrough(const std::vector<Eigen::Vector2d>& pixels) {
  std::string d;
  bool drawing = false;
  for (const Eigen::Vector2d& point : pixels) {
    if (point.allFinite()) d += (drawing ? 'L' : 'M') + at(point);
    drawing = point.allFinite();
  }
  return d;
}

std::string withHint(const std::string& shape, const std::string& hint) {
  return hint.empty() ? shape : element("g", element("title", escaped(hint)) + shape) + '\n';
}

}  // namespace

std::string seriesClass(std::size_t series) {
  return 'c' + std::to_string(series % 6);
}

std::vector<SvgTick> roundTicks(const AxisRange& range, double pixels, bool horizontal) {
  double step = tickStep(range.span(), std::max(2, static_cast<int>(pixels / 36)));
  const auto widest = [&] {
    return std::max(tickLabel(range.low, step).size(), tickLabel(range.high, step).size());
  };
  if (horizontal)
    while (step / range.span() * pixels < characterWidth * static_cast<double>(widest()) + 14)
      step = tickStep(1.5 * step, 1);
  std::vector<SvgTick> all;
  for (double value : ticks(range, step)) all.push_back({value, tickLabel(value, step)});
  return all;
}

std::vector<SvgTick> decadeTicks(const AxisRange& exponents, const std::string& unit) {
  std::vector<SvgTick> all;
  for (double exponent : ticks(exponents, 1)) {
    const int power = static_cast<int>(std::lround(exponent));
    const int shown = unit != "m" ? power : power == -3 ? 0 : power < 0 ? power + 2 : power;
    const std::string prefix = unit != "m" || power >= 0 ? "" : power == -3 ? "m" : "c";
    all.push_back({exponent, metricText(std::pow(10, shown), std::max(0, -shown)) +
                                 (unit == "°" ? "" : " ") + prefix + unit});
  }
  return all;
}

SvgPlot::SvgPlot(const std::string& id, double width, double height, const std::string& title,
                 const std::string& description)
    : m_id(id), m_title(title), m_description(description), m_width(width), m_height(height) {}

void SvgPlot::axes(const PlotAxes& axes, const std::vector<SvgTick>& x,
                   const std::vector<SvgTick>& y, const std::string& xTitle,
                   const std::string& yTitle) {
  const Rect& frame = axes.frame;
  m_shapes += "<rect class=\"panel\" x=\"" + px(frame.x) + "\" y=\"" + px(frame.y) + "\" width=\"" +
              px(frame.width) + "\" height=\"" + px(frame.height) + "\"/>\n";
  std::string grid;
  for (const SvgTick& tick : x)
    grid += 'M' + at({axes.toPixel(tick.at, axes.y.low).x(), frame.y}) + 'v' + px(frame.height);
  for (const SvgTick& tick : y)
    grid += 'M' + at({frame.x, axes.toPixel(axes.x.low, tick.at).y()}) + 'h' + px(frame.width);
  m_shapes += path(grid, "grid");
  for (const SvgTick& tick : x) {
    const double place = axes.toPixel(tick.at, axes.y.low).x();
    // At the end of the axis there may be no room for half a label.
    const bool fits =
        place + characterWidth * static_cast<double>(tick.label.size()) / 2 <= m_width;
    if (fits && !tick.label.empty()) text({place, frame.bottom() + 18}, tick.label, "middle");
  }
  for (const SvgTick& tick : y)
    text({frame.x - 7, axes.toPixel(axes.x.low, tick.at).y() + 0.35 * svgLabelSize}, tick.label,
         "end");
  if (!xTitle.empty())
    text({frame.x + frame.width / 2, m_height - 6}, xTitle, "middle", "label title");
  if (yTitle.empty()) return;
  const Eigen::Vector2d place(14, frame.y + frame.height / 2);
  m_shapes += "<text class=\"label title\" text-anchor=\"middle\" transform=\"translate(" +
              at(place) + ") rotate(-90)\">" + escaped(yTitle) + "</text>\n";
}

void SvgPlot::turnedLabels(const PlotAxes& axes, const std::vector<SvgTick>& x) {
  for (const SvgTick& tick : x) {
    const Eigen::Vector2d place(axes.toPixel(tick.at, axes.y.low).x() + 4,
                                axes.frame.bottom() + 14);
    m_shapes += "<text class=\"label\" text-anchor=\"end\" transform=\"translate(" + at(place) +
                ") rotate(-45)\">" + escaped(tick.label) + "</text>\n";
  }
}

void SvgPlot::beginClip(const Rect& frame) {
  // A nested <svg> cuts off at its own borders and needs no id.
  const std::string place = px(frame.x) + "\" y=\"" + px(frame.y) + "\" width=\"" +
                            px(frame.width) + "\" height=\"" + px(frame.height);
  m_shapes += "<svg x=\"" + place + "\" viewBox=\"" + px(frame.x) + ' ' + px(frame.y) + ' ' +
              px(frame.width) + ' ' + px(frame.height) + "\">\n";
}

void SvgPlot::endClip() {
  m_shapes += "</svg>\n";
}

void SvgPlot::line(const std::vector<Eigen::Vector2d>& pixels, const std::string& className) {
  const std::string d = pathThrough(pixels);
  if (!d.empty()) m_shapes += path(d, className);
}

void SvgPlot::dots(const std::vector<Eigen::Vector2d>& pixels, const std::string& className) {
  std::string d;
  // A line of no length with round ends is a dot.
  for (const Eigen::Vector2d& point : pixels) d += 'M' + at(point) + "h0";
  if (!d.empty()) m_shapes += path(d, className);
}

void SvgPlot::segment(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                      const std::string& className) {
  m_shapes += path('M' + at(from) + 'L' + at(to), className);
}

void SvgPlot::area(const std::vector<Eigen::Vector2d>& pixels, double bottom,
                   const std::string& className) {
  if (pixels.empty()) return;
  m_shapes += path('M' + at({pixels.front().x(), bottom}) + 'L' + pathThrough(pixels).substr(1) +
                       'L' + at({pixels.back().x(), bottom}) + 'Z',
                   className);
}

std::string SvgPlot::shape(std::size_t series, const Eigen::Vector2d& at_) const {
  const std::string className = "mark " + seriesClass(series);
  const std::string from = 'M' + at(at_);
  switch (series % 4) {
    case 0:
      return "<circle class=\"" + className + "\" cx=\"" + px(at_.x()) + "\" cy=\"" + px(at_.y()) +
             "\" r=\"4\"/>\n";
    case 1:
      return path(from + "m-3.6 -3.6h7.2v7.2h-7.2z", className);
    case 2:
      return path(from + "m0 -4.8l4.6 8h-9.2z", className);
    default:
      return path(from + "m0 -5.2l5.2 5.2l-5.2 5.2l-5.2 -5.2z", className);
  }
}

void SvgPlot::mark(std::size_t series, const Eigen::Vector2d& at_, const std::string& hint) {
  m_shapes += withHint(shape(series, at_), hint);
}

void SvgPlot::beyond(std::size_t series, const Eigen::Vector2d& at_, const std::string& hint) {
  m_shapes += withHint(
      path('M' + at(at_) + "m-5 8l5 -6l5 6m-5 -6v14", "arrow " + seriesClass(series)), hint);
}

void SvgPlot::text(const Eigen::Vector2d& at, const std::string& text, const std::string& anchor,
                   const std::string& className) {
  m_shapes += "<text class=\"" + className + "\" x=\"" + px(at.x()) + "\" y=\"" + px(at.y()) +
              "\" text-anchor=\"" + anchor + "\">" + escaped(text) + "</text>\n";
}

std::string SvgPlot::str(const std::string& className) const {
  return "<svg class=\"" + className + "\" viewBox=\"0 0 " + px(m_width) + ' ' + px(m_height) +
         "\" role=\"img\" aria-labelledby=\"" + m_id + "t " + m_id + "d\">\n<title id=\"" + m_id +
         "t\">" + escaped(m_title) + "</title>\n<desc id=\"" + m_id + "d\">" +
         escaped(m_description) + "</desc>\n" + m_shapes + "</svg>\n";
}

std::string seriesLegend(const std::vector<std::string>& names, bool marks,
                         const std::string& line) {
  std::string items;
  for (std::size_t i = 0; i < names.size(); ++i) {
    SvgPlot key("", 34, 14, "", "");
    key.segment({2, 7}, {32, 7}, line + ' ' + seriesClass(i));
    if (marks) key.mark(i, {17, 7});
    // Hidden from readers aloud: it says nothing that the name beside it does not say.
    const std::string svg = element(
        "svg", "class=\"key\" viewBox=\"0 0 34 14\" aria-hidden=\"true\"", '\n' + key.shapes());
    items += element("li", svg + escaped(names[i])) + '\n';
  }
  return element("ul", "class=\"legend\"", '\n' + items) + '\n';
}

}  // namespace polemcl::report
