#include "report/scene/PlayerPanels.h"

#include <algorithm>
#include <cmath>

#include "core/common/Statistics.h"
#include "core/common/TickStep.h"
#include "io/file/TextFile.h"
#include "mrpt/drawing/SceneParts.h"
#include "report/scene/LiveObjects.h"

namespace polemcl::report {
namespace {

using scene::TColor;

/// Rows of the panel, pixels from its lower edge.
constexpr double kStripBottom = 22, kStripTop = 32, kCurveBottom = 36, kCurveHeight = 60,
                 kText = 13, kMargin = 8;
constexpr double kLeft = 0.01, kRight = 0.99;  ///< of the width: where the time line reaches

double heightOf(bool withErrors) {
  return (withErrors ? kCurveBottom + kCurveHeight : kStripTop) + kText + 2 * kMargin;
}

/// Draws rectangles and texts in a panel, by shares of its width and pixels of its height.
class PanelPen {
 public:
  PanelPen(viz::Viewport& panel, double height) : m_panel(panel), m_height(height) {
    m_panel.getCamera().setNoProjection();
    m_panel.clearTextMessages();
  }
  static double x(double share) { return kLeft + share * (kRight - kLeft); }
  void rectangle(double from, double to, double bottom, double top, const TColor& color) {
    // Without projection, a viewport reaches from -1 to 1.
    const auto corner = [&](double share, double pixels) -> Eigen::Vector3d {
      return {2 * share - 1, 2 * pixels / m_height - 1, 0};
    };
    const auto a = corner(from, bottom), b = corner(to, bottom), c = corner(to, top),
               d = corner(from, top);
    scene::insertFace(*m_faces, a, b, c, color);
    scene::insertFace(*m_faces, a, c, d, color);
  }
  void text(double share, double pixels, const std::string& words, double size) {
    scene::addText(m_panel, share, pixels, words, m_texts++, size);
  }
  void finish() { scene::put(m_panel, "shapes", m_faces); }

 private:
  viz::Viewport& m_panel;
  double m_height;
  std::size_t m_texts = 0;
  viz::CSetOfTriangles::Ptr m_faces = viz::CSetOfTriangles::Create();
};

const TColor kEmpty(0xdd, 0xe1, 0xe6), kArea(0xc3, 0xca, 0xd3), kCurve(0x40, 0x48, 0x54),
    kMark(0x90, 0x98, 0xa4), kShown(0x10, 0x10, 0x10);

double endOf(const Playback& playback, std::size_t expected) {
  const double newest = playback.elapsed(playback.newest());
  const auto made = static_cast<double>(playback.newest());
  const double scale = made > 0 ? std::max((static_cast<double>(expected) - 1) / made, 1.0) : 1.0;
  return std::max(newest * scale, 1.0);
}

/// A round error in the upper half of the curve.
double markOf(double limit) {
  const double step = tickStep(limit, 4);
  return step * std::floor(0.95 * limit / step);
}

void drawErrors(PanelPen& pen, const TimeLine& line) {
  const auto height = [&](double error) {
    return kCurveBottom + kCurveHeight * std::min(error / line.limit, 1.0);
  };
  const auto all = static_cast<double>(line.columns.size());
  double before = 0;
  for (std::size_t i = 0; i < line.columns.size(); ++i) {
    const auto& error = line.columns[i].error;
    if (!error) continue;
    const double from = PanelPen::x(static_cast<double>(i) / all),
                 to = PanelPen::x(static_cast<double>(i + 1) / all);
    const double top = height(*error);
    const bool joined = i > 0 && line.columns[i - 1].error;
    pen.rectangle(from, to, kCurveBottom, top, kArea);
    pen.rectangle(from, to, std::min(joined ? before : top, top) - 1,
                  std::max(joined ? before : top, top) + 1, kCurve);
    before = top;
  }
  const double tick = markOf(line.limit);
  pen.rectangle(kLeft, kRight, height(tick), height(tick) + 1, kMark);
}

void drawHealth(PanelPen& pen, const TimeLine& line) {
  const auto& columns = line.columns;
  const auto all = static_cast<double>(columns.size());
  for (std::size_t from = 0, to = 0; from < columns.size(); from = to) {
    while (to < columns.size() && columns[to].state == columns[from].state) ++to;
    const auto& state = columns[from].state;
    pen.rectangle(PanelPen::x(static_cast<double>(from) / all),
                  PanelPen::x(static_cast<double>(to) / all), kStripBottom, kStripTop,
                  state ? live::pathColorOf(*state) : kEmpty);
  }
}

void drawTimes(PanelPen& pen, const TimeLine& line) {
  const double step = tickStep(line.length, 10);
  for (double tick = 0; tick < 0.97 * line.length; tick += step) {
    const double at = PanelPen::x(tick / line.length);
    pen.rectangle(at, at + 0.001, kStripBottom - 4, kStripBottom, kCurve);
    pen.text(at + 0.002, 7, io::significant(tick, 6) + " s", 10);
  }
}

/// Upper end of the errors: a little above the largest, but not above 2.2 times the 95th
/// percentile, so that the first moments of a search do not flatten the rest.
double limitOf(const std::vector<double>& errors) {
  const double largest = *std::max_element(errors.begin(), errors.end());
  return std::max(1.1 * std::min(largest, 2 * nearestRank(errors, 0.95)), 1e-3);
}

}  // namespace

TimeLine makeTimeLine(const Playback& playback, const std::vector<float>& errors,
                      std::size_t expected) {
  constexpr std::size_t columns = 500;
  TimeLine line;
  line.length = endOf(playback, expected);
  line.columns.resize(columns);
  line.shown = playback.elapsed(playback.position()) / line.length;
  const auto columnOf = [&](std::size_t scan) {
    const double share = std::clamp(playback.elapsed(scan) / line.length, 0.0, 1.0);
    return std::min(static_cast<std::size_t>(share * columns), columns - 1);
  };
  for (std::size_t scan = 0; scan <= playback.newest(); ++scan) {
    // Up to the next scan, where there are fewer scans than columns.
    const std::size_t first = columnOf(scan);
    const std::size_t last =
        scan < playback.newest() ? std::max(first + 1, columnOf(scan + 1)) : first + 1;
    const double error = errors[scan];
    for (std::size_t i = first; i < last; ++i) {
      TimeLine::Column& column = line.columns[i];
      column.state = std::max(column.state.value_or(HealthState::ok), playback.state(scan));
      if (error >= 0) column.error = std::max(column.error.value_or(0), error);
    }
  }
  std::vector<double> known;
  for (const TimeLine::Column& column : line.columns)
    if (column.error) known.push_back(*column.error);
  if (!known.empty()) line.limit = limitOf(known);
  return line;
}

std::string describe(const Playback& playback, std::size_t expected) {
  const std::size_t position = playback.position(), newest = playback.newest();
  std::string words = "scan " + std::to_string(position) + " of ";
  if (playback.hasEnded())
    words += std::to_string(newest);
  else if (expected > newest)
    words += "about " + std::to_string(expected - 1);
  else
    words += std::to_string(newest) + " so far";
  words += ", " + io::fixed(playback.elapsed(position), 1) + " s";
  if (playback.isSeeking())
    words += ", seeking: at " + io::fixed(playback.elapsed(playback.newest()), 1) + " s";
  else if (playback.isPaused())
    words += ", paused";
  return words;
}

void showTimeLine(viz::Scene& scene, const TimeLine& line, const std::string& words) {
  const bool withErrors = line.limit > 0;
  const double height = heightOf(withErrors);
  viz::Viewport& panel = scene::panelOf(scene, "player", 1);
  panel.setViewportPosition(0.008, -(10 + height), 0.984, height);
  PanelPen pen(panel, height);
  pen.rectangle(0, 1, 0, height, {0xf7, 0xf9, 0xfa});
  if (withErrors) drawErrors(pen, line);
  drawHealth(pen, line);
  drawTimes(pen, line);
  const double shown = PanelPen::x(line.shown);
  pen.rectangle(shown - 0.001, shown + 0.001, kStripBottom - 4, height - kText - 2 * kMargin,
                kShown);
  pen.text(kLeft, height - kMargin - kText, words, kText);
  if (withErrors)
    pen.text(0.5, height - kMargin - kText,
             "error of the position; line: " + io::significant(markOf(line.limit), 3) + " m", 11);
  pen.text(0.89, height - kMargin - kText, "h: help on keys", 11);
  pen.finish();
}

void showKeys(viz::Scene& scene, const std::vector<std::string>& lines, bool withErrors) {
  if (lines.empty()) return scene::hidePanel(scene::panelOf(scene, "help", 0));
  std::vector<scene::LegendLine> legend;
  legend.reserve(lines.size());
  for (const std::string& line : lines) legend.push_back({line, {}, 13});
  scene::showLegend(scene, legend, 1, {true, true, 20 + heightOf(withErrors)}, "help");
}

}  // namespace polemcl::report
