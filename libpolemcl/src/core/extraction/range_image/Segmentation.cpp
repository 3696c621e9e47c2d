#include "core/extraction/range_image/Segmentation.h"

#include <algorithm>
#include <cmath>
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

Segmentation::Segmentation(const RangeImage& image, const RangeImageOptions& options)
    : m_image(image),
      m_options(options),
      m_label(static_cast<std::size_t>(image.rows()) * image.columns(), -1) {
  const int border = options.details == ExtractionDetails::authors ? 1 : 0;
  for (int row = border; row < image.rows() - border; ++row)
    for (int column = border; column < image.columns() - border; ++column)
      if (image.valid(row, column) && label(row, column) < 0)
        grow(row, column, static_cast<std::int32_t>(m_segments.size()));
}

void Segmentation::grow(int row, int column, std::int32_t label) {
  Segment segment;
  segment.pixels.push_back({static_cast<std::int16_t>(row), column});
  m_unwrapped.assign(1, column);
  m_label[m_image.index(row, column)] = label;
  segment.minRow = segment.maxRow = row;
  int minColumn = column, maxColumn = column;

  static constexpr int kSteps[3][2] = {{0, -1}, {0, 1}, {1, 0}};  // left, right, below
  for (std::size_t i = 0; i < segment.pixels.size(); ++i) {
    const Pixel pixel = segment.pixels[i];
    const int unwrapped = m_unwrapped[i];
    for (const auto& step : kSteps) {
      const int r = pixel.row + step[0];
      int c = pixel.column + step[1];
      if (m_options.details != ExtractionDetails::authors) {
        if (r < 0 || r >= m_image.rows()) continue;
        c = m_image.wrap(c);
      } else if (r < 1 || r >= m_image.rows() - 1 || c < 1 || c >= m_image.columns() - 1) {
        continue;
      }
      const std::size_t index = m_image.index(r, c);
      if (!m_image.valid(r, c) || m_label[index] >= 0) continue;
      if (!(std::abs(m_image.range(r, c) - m_image.range(pixel.row, pixel.column)) <
            m_options.epsilon))
        continue;
      m_label[index] = label;
      segment.pixels.push_back({static_cast<std::int16_t>(r), c});
      m_unwrapped.push_back(unwrapped + step[1]);
      segment.minRow = std::min(segment.minRow, r);
      segment.maxRow = std::max(segment.maxRow, r);
      minColumn = std::min(minColumn, m_unwrapped.back());
      maxColumn = std::max(maxColumn, m_unwrapped.back());
    }
  }
  segment.width = maxColumn - minColumn + 1;
  m_segments.push_back(std::move(segment));
}

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
