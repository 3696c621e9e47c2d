#include "report/picture/MapPicture.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "io/file/TextFile.h"
#include "report/picture/ErrorStrip.h"
#include "report/picture/PictureLayout.h"
#include "report/picture/PlotAxes.h"

namespace polemcl::report {
namespace {

// Colours that stay apart for colour-blind eyes (Okabe and Ito 2008).
constexpr Color truthColor = rgb(0xaab2bd);
constexpr Color estimateColor = rgb(0x0072b2);
constexpr Color loopColor = rgb(0xcc79a7);
constexpr Color headingColor = rgb(0x009e73);

std::optional<TrajectoryErrors> compared(const MapView& view) {
  if (view.truth.size() < 2 || view.estimate.empty()) return std::nullopt;
  TrajectoryErrors errors = evaluateTrajectory(view.truth, view.estimate, Sampling::perPose);
  if (errors.errors.empty()) return std::nullopt;
  return errors;
}

std::vector<Eigen::Vector2d> pixels(const PlotAxes& axes, const std::vector<StampedPose2D>& path) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(path.size());
  for (const StampedPose2D& pose : path) points.push_back(axes.toPixel(pose.pose.x, pose.pose.y));
  return points;
}

void drawPath(Canvas& canvas, const PlotAxes& axes, const std::vector<StampedPose2D>& path,
              Color color, double width) {
  for (const auto& drive : drivesOf(path)) canvas.line(pixels(axes, drive), color, width);
}

void drawEnds(Canvas& canvas, const PlotAxes& axes, const std::vector<StampedPose2D>& path) {
  if (path.empty()) return;
  const auto mark = [&](const StampedPose2D& pose, const char* label, const Color& color) {
    const Eigen::Vector2d at = axes.toPixel(pose.pose.x, pose.pose.y);
    canvas.disc(at, 7, color, ink, 2);
    const TextStyle style{15, ink, Align::centre, true, false, true};
    const double half = 0.5 * canvas.textWidth(label, style);
    const double x = std::clamp(at.x(), axes.frame.x + half + 6, axes.frame.right() - half - 6);
    canvas.text(label, {x, at.y() + 28}, style);
  };
  mark(path.front(), "start", white);
  mark(path.back(), "end", ink);
}

/// The corner of the frame where a box of this size hides least of the view.
Rect freeCorner(const PlotAxes& axes, const MapView& view, double width, double height) {
  const Rect& frame = axes.frame;
  Rect best;
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  for (double y : {frame.bottom() - height - 10, frame.y + 10})
    for (double x : {frame.x + 10, frame.right() - width - 10}) {
      const Rect box{x, y, width, height};
      std::size_t hidden = 0;
      const auto count = [&](double px, double py) {
        const Eigen::Vector2d at = axes.toPixel(px, py);
        hidden += at.x() > box.x - 8 && at.x() < box.right() + 8 && at.y() > box.y - 8 &&
                  at.y() < box.bottom() + 8;
      };
      for (const MapPole& pole : view.poles) count(pole.x, pole.y);
      for (const StampedPose2D& pose : view.truth) count(pose.pose.x, pose.pose.y);
      for (const StampedPose2D& pose : view.estimate) count(pose.pose.x, pose.pose.y);
      if (hidden < fewest) best = box;
      fewest = std::min(fewest, hidden);
    }
  return best;
}

void drawScaleBar(Canvas& canvas, const PlotAxes& axes, const MapView& view) {
  const double metres = tickStep(axes.x.span(), 12);
  const double length = metres * axes.pixelsPerX();
  const Rect box = freeCorner(axes, view, length + 20, 42);
  const double x = box.x + 10, y = box.bottom() - 14;
  canvas.fill(box, rgb(0xffffff, 0.85));
  canvas.line({{x, y - 5}, {x, y + 5}}, ink, 2);
  canvas.line({{x + length, y - 5}, {x + length, y + 5}}, ink, 2);
  canvas.line({{x, y}, {x + length, y}}, ink, 3);
  canvas.text(tickLabel(metres, metres) + " m", {x + length / 2, y - 9}, {15, ink, Align::centre});
}

void drawMap(Canvas& canvas, const Rect& frame, const Bounds& bounds, const MapView& view) {
  const PlotAxes axes =
      equalScales(frame, {bounds.xMin, bounds.xMax}, {bounds.yMin, bounds.yMax}, 28);
  drawGrid(canvas, axes, {"x (m)", "y (m)", true, true});
  canvas.clip(frame);
  // Thinner on large maps, so that both sides of a street stay apart.
  const double metre = axes.pixelsPerX();
  drawPath(canvas, axes, view.truth, truthColor, std::clamp(2.5 * metre, 5.0, 9.0));
  drawPath(canvas, axes, view.estimate, estimateColor, std::clamp(0.8 * metre, 1.8, 2.6));
  const double smallest = std::clamp(1.5 * metre, 2.6, 4.5);
  for (const MapPole& pole : view.poles)
    canvas.disc(axes.toPixel(pole.x, pole.y), std::max(smallest, pole.radius * metre), poleColor,
                white, 0.25 * smallest);
  for (const auto& [first, second] : view.loops) {
    canvas.line({axes.toPixel(first.x(), first.y()), axes.toPixel(second.x(), second.y())},
                loopColor, 2);
    canvas.disc(axes.toPixel(second.x(), second.y()), 5, loopColor, white, 1);
  }
  drawEnds(canvas, axes, view.truth.empty() ? view.estimate : view.truth);
  drawScaleBar(canvas, axes, view);
  canvas.unclip();
  canvas.outline(frame, rgb(0xb8bfc8), 1);
}

/// From right to left, so that it ends at the margin whatever its texts are. \return Its left end.
double drawLegend(Canvas& canvas, double rightEdge, double baseline, const MapView& view) {
  const TextStyle style{17, ink, Align::right};
  double x = rightEdge;
  const auto entry = [&](const std::string& label, auto drawSymbol, double symbolWidth) {
    canvas.text(label, {x, baseline}, style);
    x -= canvas.textWidth(label, style) + 10 + symbolWidth;
    drawSymbol(x, baseline - 6);
    x -= 28;
  };
  const auto stroke = [&](const Color& color, double width) {
    return [&canvas, color, width](double from, double y) {
      canvas.line({{from, y}, {from + 42, y}}, color, width);
    };
  };
  if (!view.loops.empty())
    entry("loops (" + std::to_string(view.loops.size()) + ")", stroke(loopColor, 5), 42);
  if (!view.estimate.empty()) entry("estimate", stroke(estimateColor, 2.6), 42);
  if (!view.truth.empty()) entry("truth", stroke(truthColor, 9), 42);
  if (!view.poles.empty())
    entry(
        "poles of the map (" + std::to_string(view.poles.size()) + ")",
        [&](double from, double y) {
          canvas.disc({from + 6, y}, 6, poleColor, white, 1.2);
        },
        12);
  return x;
}

std::string summary(const MapView& view, const std::optional<TrajectoryErrors>& errors) {
  if (!errors) return "";
  const double length = distanceDriven(view.truth, {errors->errors.back()}).front();
  return std::to_string(errors->poses) + " poses over " + io::fixed(length, 0) +
         " m · position error: mean " + io::fixed(errors->posMean, 3) + " m, RMSE " +
         io::fixed(errors->posRmse, 3) + " m · heading error: mean " +
         io::fixed(errors->angMeanDeg, 3) + "°, RMSE " + io::fixed(errors->angRmseDeg, 3) + "°";
}

void drawStrips(Canvas& canvas, const PictureLayout& layout, const MapView& view,
                const TrajectoryErrors& errors) {
  ErrorSeries position{"position", "position (cm)",
                       " cm",      distanceDriven(view.truth, errors.errors),
                       {},         100 * errors.posMean};
  ErrorSeries heading{"heading", "heading (°)", "°", position.distance, {}, errors.angMeanDeg};
  for (const PoseError& error : errors.errors) {
    position.values.push_back(100 * error.position);
    heading.values.push_back(std::abs(error.heading) * 180 / M_PI);
  }
  drawErrorStrip(canvas, layout.position, position, estimateColor, false);
  drawErrorStrip(canvas, layout.heading, heading, headingColor, true);
}

}  // namespace

void drawMapPng(const MapView& view, const std::filesystem::path& file, int width, int height) {
  requireSize(width, height, file);
  const Bounds bounds = boundsOf(view);
  const std::optional<TrajectoryErrors> errors = compared(view);
  const PictureLayout layout = layoutPicture(width, height, bounds, errors.has_value());
  Canvas canvas(width, height);
  const double left = layout.map.x, right = width - 32;
  const double legend = drawLegend(canvas, right, 42, view);
  canvas.fittingText(view.title, {left, 44}, legend - left, {26, ink, Align::left, true});
  canvas.fittingText(summary(view, errors), {left, 76}, right - left, {17, rgb(0x5b6470)});
  drawMap(canvas, layout.map, bounds, view);
  if (errors) drawStrips(canvas, layout, view, *errors);
  canvas.writePng(file);
}

}  // namespace polemcl::report
