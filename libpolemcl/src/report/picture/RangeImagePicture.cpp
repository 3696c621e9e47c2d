#include "report/picture/RangeImagePicture.h"

#include <algorithm>
#include <array>

#include "core/common/Binder.h"
#include "core/extraction/range_image/RangeImageExtractor.h"
#include "report/picture/Canvas.h"

namespace polemcl::report {
namespace {

/// What a segment can be, in the order of the tests, and how it is drawn.
enum Fate { shapeFate, foregroundFate, heightFate, circleFate, freeSpaceFate, poleFate, fates };
struct FateStyle {
  const char* name;
  Color color;
};
const std::array<FateStyle, fates> fateStyles{{{"shape", rgb(0xc9ced6)},
                                               {"foreground", rgb(0x56b4e9)},
                                               {"height", rgb(0x009e73)},
                                               {"circle", rgb(0xe6b800)},
                                               {"free space", rgb(0xcc79a7)},
                                               {"poles", poleColor}}};
const std::array<Color, 6> segmentColors{rgb(0x0b4a86), rgb(0xe69f00), rgb(0x009e73),
                                         rgb(0xcc79a7), rgb(0x56b4e9), rgb(0x8a5a2b)};
constexpr Color noReturn = rgb(0xf3f4f6), nearColor = rgb(0x08306b), farColor = rgb(0xcfe1f2);

Fate fateOf(const std::optional<RejectionReason>& rejection) {
  if (!rejection) return poleFate;
  switch (*rejection) {
    case RejectionReason::notForeground:
      return foregroundFate;
    case RejectionReason::tooLow:
    case RejectionReason::startsTooHigh:
    case RejectionReason::tooShort:
      return heightFate;
    case RejectionReason::badFit:
      return circleFate;
    case RejectionReason::notFree:
      return freeSpaceFate;
    default:
      return shapeFate;
  }
}

Color mixed(const Color& a, const Color& b, double share) {
  const auto mix = [&](double from, double to) { return from + share * (to - from); };
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

/// The place of one copy of the image: upper left corner and size of one pixel, px.
struct ImagePanel {
  double x = 0, y = 0, cellWidth = 0, cellHeight = 0;

  void fill(Canvas& canvas, const Pixel& pixel, const Color& color) const {
    canvas.fill({x + pixel.column * cellWidth, y + pixel.row * cellHeight, cellWidth, cellHeight},
                color);
  }
};

void drawRanges(Canvas& canvas, const ImagePanel& panel, const RangeImage& image, double maxRange) {
  for (int row = 0; row < image.rows(); ++row)
    for (int column = 0; column < image.columns(); ++column)
      if (image.valid(row, column))
        panel.fill(canvas, {static_cast<std::int16_t>(row), column},
                   mixed(nearColor, farColor, std::min(1.0, image.range(row, column) / maxRange)));
}

void drawSegments(Canvas& canvas, const ImagePanel& panel,
                  const std::vector<SegmentOutcome>& segments) {
  for (std::size_t i = 0; i < segments.size(); ++i)
    for (const Pixel& pixel : segments[i].pixels)
      panel.fill(canvas, pixel, segmentColors[i % segmentColors.size()]);
}

void drawFates(Canvas& canvas, const ImagePanel& panel,
               const std::vector<SegmentOutcome>& segments) {
  for (const SegmentOutcome& segment : segments)
    for (const Pixel& pixel : segment.pixels)
      panel.fill(canvas, pixel, fateStyles[fateOf(segment.rejection)].color);
}

void drawFateLegend(Canvas& canvas, double x, double baseline,
                    const std::vector<SegmentOutcome>& segments) {
  std::array<std::size_t, fates> counts{};
  for (const SegmentOutcome& segment : segments) ++counts[fateOf(segment.rejection)];
  const auto write = [&](const std::string& text) {
    canvas.text(text, {x, baseline}, {17, ink});
    x += canvas.textWidth(text, {17, ink}) + 18;
  };
  write("3. Refused by the test of");
  for (int fate = 0; fate < fates; ++fate) {
    if (fate == poleFate) write("Not refused:");
    canvas.fill({x, baseline - 12, 13, 13}, fateStyles[fate].color);
    x += 19;
    write(std::string(fateStyles[fate].name) + " " + std::to_string(counts[fate]));
  }
}

}  // namespace

void drawRangeImagePng(const RangeImageView& view, const std::filesystem::path& file) {
  if (view.points.size == 0) throw Error(file.string() + ": a scan without points to draw");
  checkOptions(view.options);
  RangeImageExtractor extractor(SensorModel(view.sensor), view.sensor, view.options);
  std::vector<PoleDetection> poles;
  ExtractionReport report;
  std::vector<SegmentOutcome> segments;
  extractor.extract(view.points, poles, report, &segments);
  const RangeImage& image = extractor.image();

  constexpr double edge = 24, top = 92, caption = 44;
  ImagePanel panel{edge, top, std::max(1, 1500 / image.columns()) * 1.0,
                   std::max(2, 220 / image.rows()) * 1.0};
  const double width = panel.cellWidth * image.columns();
  const double height = panel.cellHeight * image.rows();
  Canvas canvas(static_cast<int>(width + 2 * edge),
                static_cast<int>(top + 3 * height + 2 * caption + edge));
  canvas.text(view.title, {edge, 38}, {22, ink, Align::left, true});
  const std::array<std::string, 2> captions{
      "1. Range: dark is near, grey has no return that is used. The middle looks ahead, the first "
      "quarter to the left",
      "2. Segments: " + std::to_string(segments.size()) + ", in changing colours"};
  for (int step = 0; step < 3; ++step) {
    const Rect frame{panel.x, panel.y, width, height};
    canvas.fill(frame, noReturn);
    if (step == 0) drawRanges(canvas, panel, image, view.options.maxRange);
    if (step == 1) drawSegments(canvas, panel, segments);
    if (step == 2) drawFates(canvas, panel, segments);
    canvas.outline(frame, rgb(0xb8bfc8), 1);
    if (step < 2)
      canvas.text(captions[step], {edge, panel.y - 12}, {17, ink});
    else
      drawFateLegend(canvas, edge, panel.y - 12, segments);
    panel.y += height + caption;
  }
  canvas.writePng(file);
}

}  // namespace polemcl::report
