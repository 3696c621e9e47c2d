#pragma once
/// \file SvgPlot.h
/// \brief A plot as inline SVG. Colours are classes of the page's style sheet, so that it follows
/// light and dark.

#include <string>
#include <vector>

#include "report/picture/PlotAxes.h"

namespace polemcl::report {

/// \brief Colours for series of configurations: `c0` … `c5`, then again from the first.
std::string seriesClass(std::size_t series);

/// \brief A tick of an axis where it is to stand, with its label.
struct SvgTick {
  double at = 0;  ///< value along the axis
  std::string label;
};
/// \brief Round ticks for a range of that many pixels, spaced such that labels do not touch.
std::vector<SvgTick> roundTicks(const AxisRange& range, double pixels, bool horizontal);
/// \brief The powers of ten within a range of exponents; labels by the caller's unit.
/// \param unit "m": 0.01 becomes "1 cm", as for lengths; otherwise the unit stands after the
/// number.
std::vector<SvgTick> decadeTicks(const AxisRange& exponents, const std::string& unit);

/// \brief Collects shapes; str() gives the `<svg>`.
class SvgPlot {
 public:
  /// \param id Unique on the page.
  /// \param title,description Text for those who cannot see the plot.
  SvgPlot(const std::string& id, double width, double height, const std::string& title,
          const std::string& description);

  /// \brief Background, grid, tick labels and titles (text; may be empty). With no labels the ticks
  /// are lines only.
  void axes(const PlotAxes& axes, const std::vector<SvgTick>& x, const std::vector<SvgTick>& y,
            const std::string& xTitle, const std::string& yTitle);
  /// \brief Labels below the frame, turned so that they do not touch.
  void turnedLabels(const PlotAxes& axes, const std::vector<SvgTick>& x);

  /// \brief What follows is cut off at the frame, until endClip().
  void beginClip(const Rect& frame);
  void endClip();

  /// \brief A line through pixels; NaN breaks it. \param className E.g. "line c0".
  void line(const std::vector<Eigen::Vector2d>& pixels, const std::string& className);
  /// \brief Dots of one size, as one path. \param className Its stroke width is their diameter.
  void dots(const std::vector<Eigen::Vector2d>& pixels, const std::string& className);
  void segment(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
               const std::string& className);
  /// \brief Filled area below a line, down to a pixel row.
  void area(const std::vector<Eigen::Vector2d>& pixels, double bottom,
            const std::string& className);
  /// \brief The mark of a series: circle, square, triangle or diamond. \param hint Text; may be
  /// empty.
  void mark(std::size_t series, const Eigen::Vector2d& at, const std::string& hint = "");
  /// \brief An arrowhead that points up: the value is above the plot.
  void beyond(std::size_t series, const Eigen::Vector2d& at, const std::string& hint);
  /// \param anchor "start", "middle" or "end".
  void text(const Eigen::Vector2d& at, const std::string& text, const std::string& anchor,
            const std::string& className = "label");
  /// \brief What was drawn, without the `<svg>` round it.
  const std::string& shapes() const { return m_shapes; }
  /// \brief The whole. \param className E.g. "plot wide".
  std::string str(const std::string& className) const;

 private:
  std::string shape(std::size_t series, const Eigen::Vector2d& at) const;
  std::string m_id, m_title, m_description, m_shapes;
  double m_width, m_height;
};

/// \brief Keys of series with their names, to stand below a plot. \param marks With the marks of
/// the series, not only lines.
/// \param line As the lines of the plot: "line" or "line fine".
std::string seriesLegend(const std::vector<std::string>& names, bool marks,
                         const std::string& line = "line");

}  // namespace polemcl::report
