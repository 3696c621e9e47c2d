#pragma once
/// \file Segmentation.h
/// \brief Algorithm 1 of the paper: step B1, neighbouring pixels of like range -> segments, in
/// linear time; step B2, tests of their shape, foreground and height.

#include <cstdint>
#include <optional>
#include <vector>

#include <polemcl/core/extraction/ExtractionOptions.h>
#include <polemcl/core/extraction/ExtractionReport.h>
#include "core/extraction/range_image/RangeImage.h"

namespace polemcl {

struct Pixel {
  std::int16_t row;
  std::int32_t column;  ///< in [0, columns)
};

/// \brief One segment: pixels in the order they were reached, and its bounding box.
struct Segment {
  std::vector<Pixel> pixels;
  int minRow = 0, maxRow = 0;
  int width = 0;  ///< columns it spans, counted across the seam
  int height() const { return maxRow - minRow + 1; }
};

/// \brief Segments of an image, and the label of every pixel.
class Segmentation {
 public:
  /// \brief Seeds are taken row by row from the top, in a row by column, as the open set is read.
  /// \param options epsilon and details are used.
  Segmentation(const RangeImage& image, const RangeImageOptions& options);
  const std::vector<Segment>& segments() const { return m_segments; }
  /// \brief Index of the segment a pixel belongs to, -1 for none.
  std::int32_t label(int row, int column) const { return m_label[m_image.index(row, column)]; }

 private:
  void grow(int row, int column, std::int32_t label);

  const RangeImage& m_image;
  const RangeImageOptions& m_options;
  std::vector<std::int32_t> m_label;
  std::vector<Segment> m_segments;
  std::vector<std::int32_t>
      m_unwrapped;  ///< column of each reached pixel, counted on across the seam
};

/// \brief Extent of a segment in height, m, in the frame the options' heights are meant in.
struct HeightRange {
  double low = 0, high = 0;
};

/// \brief Tests a segment in the order of Algorithm 1.
/// \param heightOffset Added to z of the points before heights are compared: height of the sensor
///        where heights are above ground, else 0.
/// \param[out] heights Filled once the shape tests have passed.
/// \return The first reason to refuse it, if any.
std::optional<RejectionReason> testCandidate(const RangeImage& image,
                                             const Segmentation& segmentation, std::int32_t label,
                                             const PointsView& points,
                                             const RangeImageOptions& options, double heightOffset,
                                             HeightRange& heights);

}  // namespace polemcl
