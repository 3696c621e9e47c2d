#include "core/extraction/range_image/PoleCandidates.h"

#include <algorithm>
#include <limits>

namespace polemcl {
namespace {

/// Share of pixels that count: see ExtractionDetails.
double foregroundShare(const RangeImage& image, const Segmentation& segmentation,
                       std::int32_t label, bool inFront) {
  const Segment& segment = segmentation.segments()[label];
  std::size_t counted = 0;
  for (const Pixel& pixel : segment.pixels) {
    bool behind = false, atEdge = false;
    for (const int step : {-1, 1}) {
      const int column = image.wrap(pixel.column + step);
      if (!image.valid(pixel.row, column) || segmentation.label(pixel.row, column) == label)
        continue;
      const float beside = image.range(pixel.row, column);
      const float own = image.range(pixel.row, pixel.column);
      atEdge = true;
      behind |= inFront ? beside <= own : beside < own;
    }
    counted += !behind && (atEdge || !inFront);
  }
  return static_cast<double>(counted) / static_cast<double>(segment.pixels.size());
}

}  // namespace

std::optional<RejectionReason> testCandidate(const RangeImage& image,
                                             const Segmentation& segmentation, std::int32_t label,
                                             const PointsView& points,
                                             const RangeImageOptions& options, double heightOffset,
                                             HeightRange& heights) {
  const Segment& segment = segmentation.segments()[label];
  if (segment.pixels.size() <= static_cast<std::size_t>(options.minPixels))
    return RejectionReason::tooFewPoints;
  if (segment.height() < options.minAspect * segment.width || segment.width > options.maxWidthPx)
    return RejectionReason::tooWide;
  if (foregroundShare(image, segmentation, label, options.details == ExtractionDetails::paper) <
      options.foreground)
    return RejectionReason::notForeground;

  heights = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Pixel& pixel : segment.pixels) {
    const double z = points.z[image.point(pixel.row, pixel.column)] + heightOffset;
    heights.low = std::min(heights.low, z);
    heights.high = std::max(heights.high, z);
  }
  if (!(heights.high > options.minTop)) return RejectionReason::tooLow;
  if (!(heights.low < options.maxBottom)) return RejectionReason::startsTooHigh;
  if (!(heights.high - heights.low > options.minHeight)) return RejectionReason::tooShort;
  return std::nullopt;
}

}  // namespace polemcl
