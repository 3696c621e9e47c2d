#pragma once
/// \file RangeImagePicture.h
/// \brief What the range-image method does with one scan, step by step, as a PNG to be looked at.

#include <filesystem>
#include <string>

#include <polemcl/core/extraction/ExtractionOptions.h>
#include <polemcl/core/sensor/SensorOptions.h>

namespace polemcl::report {

/// \brief What is drawn.
struct RangeImageView {
  std::string title;  ///< one line, UTF-8
  PointsView points;  ///< borrowed; lidar frame, as the extractor takes them
  SensorOptions sensor;
  RangeImageOptions options;
};

/// \brief Draws the range image three times: ranges; segments in changing colours; and what became
/// of each segment, with the number of poles and of segments that each kind of test refused.
///
/// One pixel of the image is a rectangle of whole pixels. The middle looks along x, the left
/// quarter along y (with `mirrored` along -y). Written atomically. Same input, same bytes on one
/// machine. \throws Error when there is no point, an option is out of range, or the file cannot be
/// written.
void drawRangeImagePng(const RangeImageView& view, const std::filesystem::path& file);

}  // namespace polemcl::report
