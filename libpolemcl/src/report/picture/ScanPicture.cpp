#include "report/picture/ScanPicture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "io/file/TextFile.h"
#include "report/picture/Canvas.h"
#include "report/picture/PlotAxes.h"

namespace polemcl::report {
namespace {

/// Heights above ground and what they are drawn in, lowest first; drawn in this order.
struct Layer {
  double from;  ///< m above ground
  Color color;
  double size;  ///< px
  const char* name;
};
const std::array<Layer, 4> layers{{{-1e9, rgb(0xd8dce1), 1.3, "below 0.3 m"},
                                   {0.3, rgb(0x7aa6cf), 1.7, "0.3 to 2 m"},
                                   {2.0, rgb(0x0b4a86), 1.7, "2 to 4 m"},
                                   {4.0, rgb(0x009e73), 1.7, "above 4 m"}}};

double ringOf(const PlotAxes& axes, const PoleDetection& pole) {
  return std::max(9.0, pole.radius * axes.pixelsPerX() + 5);
}

double reachOf(const ScanView& view) {
  double reach = 12;
  for (const PoleDetection& pole : view.poles) {
    if (!std::isfinite(pole.x + pole.y + pole.top + pole.confidence))
      throw Error("a pole of the picture has a number that is not finite");
    reach = std::max({reach, std::abs(pole.x) + 3, std::abs(pole.y) + 3});
  }
  return std::min(reach, 60.0);
}

void drawPoints(Canvas& canvas, const PlotAxes& axes, const ScanView& view) {
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const double from = layers[k].from + view.ground;
    const double to = k + 1 < layers.size() ? layers[k + 1].from + view.ground
                                            : std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < view.points.size; ++i) {
      const double x = view.points.x[i], y = view.points.y[i], z = view.points.z[i];
      if (!(z >= from && z < to) || !std::isfinite(x + y)) continue;
      const Eigen::Vector2d at = axes.toPixel(x, y);
      if (at.x() < axes.frame.x || at.x() > axes.frame.right() || at.y() < axes.frame.y ||
          at.y() > axes.frame.bottom())
        continue;
      const double size = layers[k].size;
      canvas.fill({at.x() - size / 2, at.y() - size / 2, size, size}, layers[k].color);
    }
  }
}

bool overlap(const Rect& a, const Rect& b) {
  return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
}

/// Beside the ring, above or below it, inside the frame: the first place where no text is yet, else
/// the last tried.
Rect labelPlace(const Rect& frame, const Eigen::Vector2d& at, double ring, double width,
                const std::vector<Rect>& taken) {
  constexpr double height = 15;
  Rect place;
  for (const double y : {-0.5 * height, -ring - height, ring})
    for (const double x : {ring + 4, -ring - 4 - width}) {
      if (at.x() + x + width > frame.right()) continue;
      place = {at.x() + x, at.y() + y, width, height};
      if (std::none_of(taken.begin(), taken.end(),
                       [&](const Rect& other) { return overlap(place, other); }))
        return place;
    }
  return place;
}

void drawPoles(Canvas& canvas, const PlotAxes& axes, const ScanView& view) {
  const TextStyle style{13, ink, Align::left, false, false, true};
  std::vector<Rect> taken;
  for (const PoleDetection& pole : view.poles) {
    const Eigen::Vector2d at = axes.toPixel(pole.x, pole.y);
    const double ring = ringOf(axes, pole);
    canvas.disc(at, ring, rgb(0xffffff, 0), poleColor, 2.4);
    taken.push_back({at.x() - ring, at.y() - ring, 2 * ring, 2 * ring});
  }
  for (const PoleDetection& pole : view.poles) {
    const std::string label = io::fixed(pole.top, 1) + " m · " + io::fixed(pole.confidence, 2);
    const Rect place = labelPlace(axes.frame, axes.toPixel(pole.x, pole.y), ringOf(axes, pole),
                                  canvas.textWidth(label, style), taken);
    canvas.text(label, {place.x, place.bottom() - 3}, style);
    taken.push_back(place);
  }
}

void drawScanLegend(Canvas& canvas, const Rect& frame, double baseline, const ScanView& view) {
  double x = frame.x;
  const auto entry = [&](const std::string& label, auto drawSymbol) {
    drawSymbol(Eigen::Vector2d(x + 7, baseline - 6));
    canvas.text(label, {x + 20, baseline}, {16, ink});
    x += 20 + canvas.textWidth(label, {16, ink}) + 24;
  };
  for (const Layer& layer : layers)
    entry(layer.name, [&](const Eigen::Vector2d& at) {
      canvas.fill({at.x() - 5, at.y() - 5, 10, 10}, layer.color);
    });
  entry(std::to_string(view.poles.size()) + " poles: top above ground · confidence",
        [&](const Eigen::Vector2d& at) { canvas.disc(at, 7, rgb(0xffffff, 0), poleColor, 2.4); });
}

}  // namespace

void drawScanPng(const ScanView& view, const std::filesystem::path& file, int size) {
  if (size < 800)
    throw Error(file.string() + ": a picture of " + std::to_string(size) +
                " px; at least 800 are needed");
  if (view.points.size == 0) throw Error(file.string() + ": a scan without points to draw");
  const double reach = reachOf(view);
  Canvas canvas(size, size);
  const Rect frame{80, 84, size - 104.0, size - 144.0};
  const PlotAxes axes = equalScales(frame, {-reach, reach}, {-reach, reach}, 0);
  drawGrid(canvas, axes, {"x (m)", "y (m)", true, true});
  canvas.clip(frame);
  drawPoints(canvas, axes, view);
  const Eigen::Vector2d sensor = axes.toPixel(0, 0);
  canvas.disc(sensor, 6, ink, rgb(0xffffff), 1.5);
  drawPoles(canvas, axes, view);
  canvas.unclip();
  canvas.outline(frame, rgb(0xb8bfc8), 1);
  canvas.text(view.title, {frame.x, 38}, {22, ink, Align::left, true});
  drawScanLegend(canvas, frame, 70, view);
  canvas.writePng(file);
}

}  // namespace polemcl::report
