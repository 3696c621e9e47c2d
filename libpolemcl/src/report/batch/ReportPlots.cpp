#include <algorithm>
#include <cmath>

#include "report/batch/Html.h"
#include "report/batch/NumberFormat.h"
#include "report/batch/ReportParts.h"
#include "report/batch/SvgPlot.h"
#include "report/picture/ErrorStrip.h"

namespace polemcl::report {
namespace {

constexpr std::size_t longestLabel = 16;
constexpr std::size_t mostLabels = 60;

std::vector<std::string> configurationNames(const BatchResults& results) {
  std::vector<std::string> names;
  for (const BatchConfiguration& configuration : results.configurations)
    names.push_back(configuration.name);
  return names;
}

std::string figure(const std::string& plot, const std::string& legend, const std::string& caption,
                   const std::string& className = "") {
  return element("figure", classed(className),
                 element("div", "class=\"scroll\" tabindex=\"0\"", '\n' + plot) + '\n' + legend +
                     element("figcaption", caption)) +
         '\n';
}

/// A name that fits below a plot.
std::string shortName(const std::string& name) {
  std::size_t length = 0, end = 0;
  while (end < name.size() && length < longestLabel) {
    do ++end;
    while (end < name.size() && (name[end] & 0xC0) == 0x80);
    ++length;
  }
  return end == name.size() ? name : name.substr(0, end) + "\xE2\x80\xA6";
}

/// Width of the longest label, pixels.
double labelWidth(const BatchResults& results) {
  std::size_t longest = 0;
  for (const BatchSession& session : results.sessions)
    longest = std::max(longest, std::min(session.name.size(), longestLabel + 1));
  return 7.4 * static_cast<double>(longest);
}

/// Whether the labels have to be turned by 45 degrees on an axis that long.
bool turned(const BatchResults& results, double pixels) {
  return labelWidth(results) + 12 > pixels / static_cast<double>(results.sessions.size());
}

/// Ticks of an axis of errors, and their unit: centimetres for lengths below 0.1 m.
struct ErrorTicks {
  std::vector<SvgTick> ticks;
  std::string unit;
};
ErrorTicks errorTicks(const PlotAxes& axes, const std::string& unit) {
  const bool isShort = unit == "m" && axes.y.high <= 0.1;
  const double scale = isShort ? 100 : 1;
  ErrorTicks result{roundTicks({scale * axes.y.low, scale * axes.y.high}, axes.frame.height, false),
                    isShort ? "cm" : unit};
  for (SvgTick& tick : result.ticks) tick.at /= scale;
  return result;
}

/// The sessions x configurations plot, drawn part by part.
class SessionsPlot {
 public:
  SessionsPlot(const BatchResults& results, const Summaries& summaries,
               const SessionQuantity& quantity, const std::string& id)
      : m_results(results),
        m_summaries(summaries),
        m_quantity(quantity),
        m_plot(id, width, heightOf(results), quantity.name + " per session",
               "Mean over the runs of each session, bars of one standard deviation, for " +
                   plural(results.configurations.size(), "setting") + ".") {
    const double left =
        turned(results, plotWidth) ? std::max(64.0, 0.71 * labelWidth(results) - 10) : 64;
    m_axes.frame = {left, 12, width - left - 14, plotHeight};
    m_axes.x = {-0.5, static_cast<double>(results.sessions.size()) - 0.5};
    m_axes.y = {0, limit()};
  }
  std::string draw() {
    drawAxes();
    for (std::size_t i = 0; i < m_summaries.size(); ++i) drawConfiguration(i);
    return m_plot.str("plot wide");
  }
  /// What lies above the plot, in words.
  const std::vector<std::string>& beyond() const { return m_beyond; }

 private:
  static constexpr double width = 960, plotWidth = 880, plotHeight = 270;
  static double heightOf(const BatchResults& results) {
    const double labels = turned(results, plotWidth) ? 16 + 0.71 * labelWidth(results) : 20;
    return 12 + plotHeight + labels + 26;
  }
  const Spread& spreadOf(const SessionSummary& session) const {
    return session.figures.*m_quantity.spread;
  }
  double limit() const {
    std::vector<double> tops;
    for (const ConfigurationSummary& configuration : m_summaries)
      for (const SessionSummary& session : configuration.sessions) {
        const Spread& spread = spreadOf(session);
        if (spread.count > 0)
          tops.push_back(spread.mean + (spread.count > 1 ? spread.deviation : 0));
      }
    return tops.empty() ? 1 : valueLimit(tops);
  }
  void drawAxes() {
    const std::size_t count = m_results.sessions.size();
    const std::size_t every = (count + mostLabels - 1) / mostLabels;
    const bool isTurned = turned(m_results, plotWidth);
    std::vector<SvgTick> lines, labels;
    for (std::size_t i = 0; i < count; i += every) {
      labels.push_back({double(i), shortName(m_results.sessions[i].name)});
      lines.push_back({double(i), isTurned ? "" : labels.back().label});
    }
    const ErrorTicks errors = errorTicks(m_axes, m_quantity.unit);
    m_plot.axes(m_axes, lines, errors.ticks, "session", m_quantity.name + " (" + errors.unit + ")");
    if (isTurned) m_plot.turnedLabels(m_axes, labels);
  }
  /// Configurations stand side by side within a session.
  double offset(std::size_t configuration) const {
    const double slot = m_axes.pixelsPerX();
    const double apart = std::min(11.0, slot / static_cast<double>(m_summaries.size() + 1));
    return (static_cast<double>(configuration) -
            static_cast<double>(m_summaries.size() - 1) / 2.0) *
           apart;
  }
  void drawConfiguration(std::size_t index) {
    std::vector<Eigen::Vector2d> means(m_results.sessions.size(),
                                       Eigen::Vector2d(noFigure, noFigure));
    for (const SessionSummary& session : m_summaries[index].sessions) {
      const Spread& spread = spreadOf(session);
      if (spread.count == 0) continue;
      means[session.session] = m_axes.toPixel(static_cast<double>(session.session), spread.mean) +
                               Eigen::Vector2d(offset(index), 0);
    }
    m_plot.beginClip(m_axes.frame);
    m_plot.line(means, "line thin " + seriesClass(index));
    for (const SessionSummary& session : m_summaries[index].sessions)
      if (spreadOf(session).count > 1 && spreadOf(session).mean <= m_axes.y.high)
        drawSpread(index, spreadOf(session), means[session.session].x());
    m_plot.endClip();
    for (const SessionSummary& session : m_summaries[index].sessions)
      if (spreadOf(session).count > 0) drawMark(index, session, means[session.session]);
  }
  void drawSpread(std::size_t index, const Spread& spread, double x) {
    const double low = m_axes.toPixel(0, std::max(0.0, spread.mean - spread.deviation)).y();
    const double high = m_axes.toPixel(0, spread.mean + spread.deviation).y();
    m_plot.segment({x, low}, {x, high}, "spread " + seriesClass(index));
  }
  void drawMark(std::size_t index, const SessionSummary& session, const Eigen::Vector2d& at) {
    const Spread& spread = spreadOf(session);
    const std::string hint =
        m_results.sessions[session.session].name + ", " + m_results.configurations[index].name +
        ": " +
        (m_quantity.unit == "m" ? lengthText(spread.mean, " ")
                                : metricText(spread.mean, 3) + ' ' + m_quantity.unit);
    if (spread.mean <= m_axes.y.high) return m_plot.mark(index, at, hint);
    m_plot.beyond(index, {at.x(), m_axes.frame.y + 4}, hint);
    m_beyond.push_back(hint);
  }

  const BatchResults& m_results;
  const Summaries& m_summaries;
  const SessionQuantity& m_quantity;
  SvgPlot m_plot;
  PlotAxes m_axes;
  std::vector<std::string> m_beyond;
};

std::vector<ErrorHistogram> histogramsOf(const BatchResults& results,
                                         ErrorHistogram SessionPlots::*histogram) {
  std::vector<ErrorHistogram> sums(results.configurations.size());
  for (const SessionResult& result : results.results)
    sums[result.configuration].add(result.plots.*histogram);
  return sums;
}

/// The decades that hold all counts, at least two.
AxisRange exponentsOf(const std::vector<ErrorHistogram>& histograms) {
  std::size_t first = ErrorHistogram::bins, last = 0;
  for (const ErrorHistogram& histogram : histograms)
    for (std::size_t i = 0; i < ErrorHistogram::bins; ++i)
      if (histogram.counts[i] > 0) first = std::min(first, i), last = std::max(last, i);
  if (first > last) return {0, 0};
  const std::size_t low = first / 10 * 10;
  return {static_cast<double>(low) / 10.0 - 3,
          static_cast<double>(std::max(low + 20, last / 10 * 10 + 10)) / 10.0 - 3};
}

/// Steps of a histogram in pixels, empty ends left out.
std::vector<Eigen::Vector2d> steps(const PlotAxes& axes, const ErrorHistogram& histogram) {
  const double all = double(histogram.total());
  std::vector<Eigen::Vector2d> line;
  for (std::size_t i = 0; i < ErrorHistogram::bins; ++i) {
    const double low = static_cast<double>(i) / 10.0 - 3;
    const double share = static_cast<double>(100 * histogram.counts[i]) / all;
    if (low < axes.x.low - 1e-9 || low > axes.x.high - 1e-9) continue;
    line.push_back(axes.toPixel(low, share));
    line.push_back(axes.toPixel(low + 0.1, share));
  }
  return line;
}

/// Steps at the largest value of each bin; bins without one break the line.
std::vector<Eigen::Vector2d> steps(const PlotAxes& axes, const BinnedMaxima& bins) {
  std::vector<Eigen::Vector2d> line;
  for (std::size_t i = 0; i < bins.largest.size(); ++i) {
    line.push_back(axes.toPixel(static_cast<double>(i) * bins.binWidth, bins.largest[i]));
    if (i + 1 == bins.largest.size() || !std::isfinite(bins.largest[i + 1]))
      line.push_back(axes.toPixel(static_cast<double>(i + 1) * bins.binWidth, bins.largest[i]));
  }
  return line;
}

}  // namespace

std::string sessionsFigure(const BatchResults& results, const Summaries& summaries,
                           const SessionQuantity& quantity, PlotIds& ids) {
  SessionsPlot plot(results, summaries, quantity, ids.next());
  const std::string svg = plot.draw();
  std::string caption = quantity.name +
                        " of each session: mean over its runs, bars of one "
                        "standard deviation.";
  caption.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(caption.front())));
  for (std::size_t i = 0; i < plot.beyond().size(); ++i)
    caption += (i == 0 ? " Arrows: above the plot, " : "; ") + plot.beyond()[i];
  if (!plot.beyond().empty()) caption += '.';
  return figure(svg, seriesLegend(configurationNames(results), true), escaped(caption));
}

std::string histogramFigure(const BatchResults& results, const HistogramQuantity& quantity,
                            PlotIds& ids) {
  const std::vector<ErrorHistogram> histograms = histogramsOf(results, quantity.histogram);
  PlotAxes axes{{58, 12, 398, 240}, exponentsOf(histograms), {0, 0}};
  if (!(axes.x.span() > 0)) return "";
  std::vector<std::string> counted;
  for (std::size_t i = 0; i < histograms.size(); ++i) {
    const auto all = histograms[i].total();
    if (all == 0) continue;
    for (auto count : histograms[i].counts)
      axes.y.high =
          std::max(axes.y.high, 110.0 * static_cast<double>(count) / static_cast<double>(all));
    counted.push_back(results.configurations[i].name + ' ' + countText(all));
  }
  SvgPlot plot(ids.next(), 480, 300, "Histogram of the " + quantity.name,
               "Share of the compared poses of all runs and sessions over the error on a "
               "logarithmic scale.");
  plot.axes(axes, decadeTicks(axes.x, quantity.unit), roundTicks(axes.y, axes.frame.height, false),
            quantity.name, "share of poses (%)");
  for (std::size_t i = 0; i < histograms.size(); ++i) {
    if (histograms[i].total() == 0) continue;
    const auto line = steps(axes, histograms[i]);
    plot.area(line, axes.frame.bottom(), "area " + seriesClass(i));
    plot.line(line, "line " + seriesClass(i));
  }
  std::string caption = "Poses compared: ";
  for (std::size_t i = 0; i < counted.size(); ++i) caption += (i == 0 ? "" : ", ") + counted[i];
  return figure(plot.str("plot"), seriesLegend(configurationNames(results), false),
                escaped(caption + '.'));
}

std::string distanceFigure(const BatchResults& results, std::size_t session, PlotIds& ids) {
  std::vector<double> values;
  double length = 0, bin = 0;
  for (std::size_t i = 0; i < results.configurations.size(); ++i)
    if (const SessionResult* result = results.find(i, session)) {
      const BinnedMaxima& bins = result->plots.position;
      for (double value : bins.largest)
        if (std::isfinite(value)) values.push_back(value);
      if (bins.largest.empty()) continue;
      length = std::max(length, static_cast<double>(bins.largest.size()) * bins.binWidth);
      bin = std::max(bin, bins.binWidth);
    }
  if (values.empty()) return "";
  const double largest = *std::max_element(values.begin(), values.end());
  const PlotAxes axes{{64, 12, 882, 190}, {0, length}, {0, valueLimit(values)}};
  SvgPlot plot(ids.next(), 960, 252, "Position error over distance",
               "Position error of run 0 over the distance driven, the largest in every " +
                   metricText(bin, 0) + " m.");
  const ErrorTicks errors = errorTicks(axes, "m");
  plot.axes(axes, roundTicks(axes.x, axes.frame.width, true), errors.ticks, "distance driven (m)",
            "position error (" + errors.unit + ")");
  plot.beginClip(axes.frame);
  for (std::size_t i = 0; i < results.configurations.size(); ++i)
    if (const SessionResult* result = results.find(i, session))
      plot.line(steps(axes, result->plots.position), "line fine " + seriesClass(i));
  plot.endClip();
  std::string caption = "Position error of run 0, the largest in every " + metricText(bin, 0) +
                        " m driven; at most " + lengthText(largest);
  caption += largest > axes.y.high ? ", which is above the plot." : ".";
  return figure(plot.str("plot wide"),
                seriesLegend(configurationNames(results), false, "line fine"), caption);
}

}  // namespace polemcl::report
