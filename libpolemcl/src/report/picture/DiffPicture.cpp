#include "report/picture/DiffPicture.h"

#include <algorithm>
#include <functional>

#include "report/picture/MapView.h"
#include "report/picture/PictureLayout.h"
#include "report/picture/PlotAxes.h"

namespace polemcl::report {
namespace {

// Colours that stay apart for colour-blind eyes (Okabe and Ito 2008).
constexpr Color sameColor = rgb(0xaab2bd);
constexpr Color newColor = rgb(0x009e73);
constexpr Color vanishedColor = rgb(0xd55e00);
constexpr Color movedColor = rgb(0x0072b2);

Bounds boundsOfAll(const MapDiff& diff) {
  MapView all;
  all.poles = diff.appeared;
  all.poles.insert(all.poles.end(), diff.vanished.begin(), diff.vanished.end());
  for (const auto* pairs : {&diff.same, &diff.moved})
    for (const MapDiff::Pair& pair : *pairs) {
      all.poles.push_back(pair.before);
      all.poles.push_back(pair.after);
    }
  return boundsOf(all);
}

void drawDiffPoles(Canvas& canvas, const PlotAxes& axes, const MapDiff& diff) {
  const double size = std::clamp(1.5 * axes.pixelsPerX(), 2.6, 4.5), large = 1.6 * size;
  const auto at = [&](const MapPole& pole) { return axes.toPixel(pole.x, pole.y); };
  for (const MapDiff::Pair& pair : diff.same)
    canvas.disc(at(pair.after), size, sameColor, white, 1);
  for (const MapPole& pole : diff.vanished)
    canvas.disc(at(pole), large, white, vanishedColor, 0.5 * large);
  for (const MapDiff::Pair& pair : diff.moved) {
    canvas.line({at(pair.before), at(pair.after)}, movedColor, 2);
    canvas.disc(at(pair.before), size, white, movedColor, 0.5 * size);
    canvas.disc(at(pair.after), large, movedColor, white, 1);
  }
  for (const MapPole& pole : diff.appeared) canvas.disc(at(pole), large, newColor, white, 1);
}

/// From right to left, so that it ends at the margin whatever its texts are. \return Its left end.
double drawLegendOf(Canvas& canvas, double x, double baseline, const MapDiff& diff) {
  struct Entry {
    std::string label;
    Color inside, rim;
    double rimWidth;
  };
  const auto count = [](std::size_t n) { return " (" + std::to_string(n) + ")"; };
  for (const Entry& entry :
       {Entry{"the same" + count(diff.same.size()), sameColor, white, 1},
        Entry{"moved" + count(diff.moved.size()), movedColor, white, 1},
        Entry{"vanished" + count(diff.vanished.size()), white, vanishedColor, 3},
        Entry{"new" + count(diff.appeared.size()), newColor, white, 1}}) {
    const TextStyle style{17, ink, Align::right};
    canvas.text(entry.label, {x, baseline}, style);
    x -= canvas.textWidth(entry.label, style) + 16;
    canvas.disc({x, baseline - 6}, 6, entry.inside, entry.rim, entry.rimWidth);
    x -= 30;
  }
  return x;
}

}  // namespace

void drawDiffPng(const MapDiff& diff, const std::string& title, const std::filesystem::path& file,
                 int width, int height) {
  requireSize(width, height, file);
  const Bounds bounds = boundsOfAll(diff);
  const PictureLayout layout = layoutPicture(width, height, bounds, false);
  const PlotAxes axes =
      equalScales(layout.map, {bounds.xMin, bounds.xMax}, {bounds.yMin, bounds.yMax}, 28);
  Canvas canvas(width, height);
  const double legend = drawLegendOf(canvas, width - 32, 42, diff);
  canvas.fittingText(title, {layout.map.x, 44}, legend - layout.map.x,
                     {26, ink, Align::left, true});
  drawGrid(canvas, axes, {"x (m)", "y (m)", true, true});
  canvas.clip(layout.map);
  drawDiffPoles(canvas, axes, diff);
  canvas.unclip();
  canvas.outline(layout.map, rgb(0xb8bfc8), 1);
  canvas.writePng(file);
}

}  // namespace polemcl::report
