#pragma once
/// \file PoleCandidates.h
/// \brief Step B2 of the paper: shape, foreground and height tests on segments (Algorithm 1).

#include <optional>

#include <polemcl/core/extraction/ExtractionOptions.h>
#include <polemcl/core/extraction/ExtractionReport.h>
#include "core/extraction/range_image/Segmentation.h"

namespace polemcl {

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
