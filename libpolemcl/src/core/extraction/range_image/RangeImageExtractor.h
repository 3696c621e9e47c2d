#pragma once
/// \file RangeImageExtractor.h
/// \brief Algorithm 1 of Dong et al. 2021, A to B3, on one screen. Private to the library.

#include <polemcl/core/extraction/ExtractionReport.h>
#include <polemcl/core/sensor/SensorOptions.h>
#include "core/extraction/range_image/CircleFit.h"
#include "core/extraction/range_image/RangeImage.h"
#include "core/extraction/range_image/Segmentation.h"
#include "core/sensor/SensorModel.h"

namespace polemcl {

/// \brief What became of one segment.
struct SegmentOutcome {
  std::vector<Pixel> pixels;
  std::optional<RejectionReason> rejection;  ///< why it is not a pole; empty for a pole
};

/// \brief The options with the size and the field of view that they leave to the sensor.
RangeImageOptions adaptedTo(const SensorModel& beams, RangeImageOptions options);

class RangeImageExtractor {
 public:
  /// \param beams Rings of the sensor, or lines of pixels of a depth camera.
  RangeImageExtractor(const SensorModel& beams, const SensorOptions& sensor,
                      const RangeImageOptions& options);
  /// \param[out] outcomes One for each segment, for those who draw them.
  void extract(const PointsView& points, std::vector<PoleDetection>& poles,
               ExtractionReport& report, std::vector<SegmentOutcome>* outcomes = nullptr);
  /// \brief The image of the last scan.
  const RangeImage& image() const { return m_image; }

 private:
  /// Square around a circle and its segment of heights, frame of the points.
  struct Box {
    Circle centre;
    double half = 0;  ///< half the side, m
    double low = 0, high = 0;
  };
  struct Point {
    double x, y, z;
  };

  /// Points in columns of 1 m x 1 m, so that a box is searched without reading the whole cloud.
  /// Those beyond the outermost columns are in them.
  void sortIntoCells(const PointsView& points);
  int cellAlong(double coordinate) const;
  /// Calls f for each point with `low < z < high` in columns within `reach` of the centre.
  template <class F>
  void eachNear(const Box& box, double reach, const PointsView& points, F f) const;
  bool between(double value, double low, double high) const;
  std::optional<Circle> fit(const std::vector<Eigen::Vector2d>& points, bool singlePrecision) const;
  std::vector<Eigen::Vector2d> segmentPoints(const Segment& segment,
                                             const PointsView& points) const;
  std::vector<Eigen::Vector2d> pointsInside(const Box& box, const PointsView& points) const;
  std::optional<RejectionReason> fitPole(const Segment& segment, const HeightRange& heights,
                                         const PointsView& points, PoleDetection& pole) const;
  bool isFree(const Box& box, std::size_t fitted, const PointsView& points) const;

  RangeImageOptions m_options;
  double m_minRange;      ///< m
  double m_height;        ///< of the points' origin above ground, m
  double m_heightOffset;  ///< from z to the heights that the options are meant in, m
  RangeImage m_image;
  int m_cells;  ///< per side
  std::vector<std::uint32_t> m_cellStart, m_cellPoints;
};

}  // namespace polemcl
