#include <polemcl/core/PoleCandidates.h>

#include <algorithm>
#include <limits>

namespace polemcl {
namespace {

/// Share of pixels that no valid pixel outside the segment, to their left or right, is nearer than.
double foregroundShare(const RangeImage& image, const Segmentation& segmentation,
                       std::int32_t label) {
  const Segment& segment = segmentation.segments()[label];
  std::size_t before = 0;
  for (const Pixel& pixel : segment.pixels) {
    bool behind = false;
    for (const int step : {-1, 1}) {
      const int column = image.wrap(pixel.column + step);
      if (!image.valid(pixel.row, column) || segmentation.label(pixel.row, column) == label)
        continue;
      behind |= image.range(pixel.row, column) < image.range(pixel.row, pixel.column);
    }
    before += !behind;
  }
  return static_cast<double>(before) / static_cast<double>(segment.pixels.size());
}

}  // namespace

Refusal testCandidate(const RangeImage& image, const Segmentation& segmentation, std::int32_t label,
                      const PointsView& points, const PaperOptions& options, double heightOffset,
                      HeightRange& heights) {
  const Segment& segment = segmentation.segments()[label];
  if (segment.pixels.size() <= static_cast<std::size_t>(options.minPixels))
    return Refusal::tooFewPoints;
  if (segment.height() < options.minAspect * segment.width || segment.width > options.maxWidthPx)
    return Refusal::tooWide;
  if (foregroundShare(image, segmentation, label) < options.foreground)
    return Refusal::notForeground;

  heights = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Pixel& pixel : segment.pixels) {
    const double z = points.z[image.point(pixel.row, pixel.column)] + heightOffset;
    heights.low = std::min(heights.low, z);
    heights.high = std::max(heights.high, z);
  }
  if (!(heights.high > options.minTop)) return Refusal::tooLow;
  if (!(heights.low < options.maxBottom)) return Refusal::startsTooHigh;
  if (!(heights.high - heights.low > options.minHeight)) return Refusal::tooShort;
  return Refusal::count_;
}

}  // namespace polemcl
