#pragma once
/// \file Pictures.h
/// \brief Maps, drives and scans as PNGs. share/report/draw.py draws them, by Matplotlib.
///
/// Written atomically. The same input gives the same bytes with the same release of Matplotlib.
/// All throw Error when there is nothing to show, a number is not finite, Python or Matplotlib is
/// missing, or the file cannot be written.

#include <filesystem>
#include <string>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/extraction/ExtractionOptions.h>
#include <polemcl/core/sensor/SensorOptions.h>
#include "core/mapping/MapDiff.h"
#include "report/picture/MapView.h"

namespace polemcl::report {

/// \brief The map from above (x right, y up, equal scales, axes in metres) with poles, truth,
/// estimate and loops, a legend and a scale bar. When truth and estimate are both given, also the
/// errors of position and heading over the distance driven. \throws Error also when these do not
/// overlap in time (evaluateTrajectory()).
void drawMapPng(const MapView& view, const std::filesystem::path& file);

/// \brief What stayed in grey, what is new in green, what vanished as an orange ring, what moved in
/// blue with a line from its old place, and how many there are of each.
void drawDiffPng(const MapDiff& diff, const std::string& title, const std::filesystem::path& file);

/// \brief What drawScanPng() shows. Points and poles in one frame, the sensor at its origin, z up.
struct ScanView {
  std::string title;  ///< one line, UTF-8
  PointsView points;  ///< borrowed; those that are not finite are not drawn
  double ground = 0;  ///< height of the ground in that frame, m
  std::vector<PoleDetection> poles;
};
/// \brief A scan from above: points coloured by their height above the ground, a ring round each
/// pole with its top (m) and confidence beside it. Shows all poles, 12 to 60 m to each side.
void drawScanPng(const ScanView& view, const std::filesystem::path& file);

/// \brief What drawRangeImagePng() shows.
struct RangeImageView {
  std::string title;  ///< one line, UTF-8
  PointsView points;  ///< borrowed; lidar frame, as the extractor takes them
  SensorOptions sensor;
  RangeImageOptions options;
};
/// \brief The range image three times: ranges; segments in changing colours; and what became of
/// each segment, with the number of poles and of segments that each kind of test refused. The
/// middle looks along x, the left quarter along y (with `mirrored` along -y).
void drawRangeImagePng(const RangeImageView& view, const std::filesystem::path& file);

}  // namespace polemcl::report
