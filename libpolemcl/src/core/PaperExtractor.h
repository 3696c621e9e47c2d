#pragma once
/// \file PaperExtractor.h
/// \brief Algorithm 1 of Dong et al. 2021, A to B3, on one screen. Private to the library.

#include <polemcl/core/CircleFit.h>
#include <polemcl/core/PoleCandidates.h>
#include <polemcl/core/PoleExtractor.h>
#include <polemcl/core/RangeImage.h>

namespace polemcl {

class PaperExtractor {
 public:
  PaperExtractor(const SensorOptions& sensor, const PaperOptions& options);
  void extract(const PointsView& points, std::vector<PoleDetection>& poles,
               ExtractionReport& report);

 private:
  /// Points in columns of 1 m x 1 m, so that a box is searched without reading the whole cloud.
  void sortIntoCells(const PointsView& points);
  template <class F>
  void eachInBox(const Circle& centre, double half, F f) const;
  std::optional<Circle> fit(const std::vector<Eigen::Vector2d>& points) const;
  std::vector<Eigen::Vector2d> segmentPoints(const Segment& segment,
                                             const PointsView& points) const;
  Refusal fitPole(const Segment& segment, const HeightRange& heights, const PointsView& points,
                  PoleDetection& pole) const;
  bool isFree(const Circle& coarse, double half, double low, double high, std::size_t fitted,
              const PointsView& points) const;

  SensorOptions m_sensor;
  PaperOptions m_options;
  double m_heightOffset;
  RangeImage m_image;
  int m_cells;  ///< per side
  std::vector<std::uint32_t> m_cellStart, m_cellPoints;
};

}  // namespace polemcl
