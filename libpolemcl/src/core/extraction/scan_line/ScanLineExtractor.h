#pragma once
/// \file ScanLineExtractor.h
/// \brief The native method, A to B3, on one screen. Private to the library; see PoleExtractor.h.

#include <polemcl/core/extraction/ExtractionOptions.h>
#include <polemcl/core/extraction/ExtractionReport.h>
#include <polemcl/core/sensor/PinholeCamera.h>
#include <polemcl/core/sensor/SensorOptions.h>

#include "core/extraction/PoleClassifier.h"
#include "core/extraction/VisibilityRange.h"
#include "core/extraction/scan_line/CandidateFeatures.h"

namespace polemcl {

class ScanLineExtractor {
 public:
  /// \param model Made from the same options, or from a depth camera.
  ScanLineExtractor(SensorModel model, const SensorOptions& sensor, const ScanLineOptions& options);
  /// \param upright See PoleExtractor::extract().
  void extract(const PointsView& points, const Eigen::Vector2f& upright,
               std::vector<PoleDetection>& poles, ExtractionReport& report);
  /// \brief Of the last scan, as VisibilityRangeFinder gives it.
  const std::vector<float>& visibilityRange() const { return m_freeRange; }

 private:
  /// \return The reason of the refusal, or RejectionReason::count_ when `pole` and `lean` were
  /// filled.
  RejectionReason examine(const SegmentCluster& stack, PoleDetection& pole, PoleTilt& lean);
  void setUpright(std::vector<PoleDetection>& poles) const;
  RejectionReason judgeShape(const SegmentCluster& stack, ClusterShape& shape) const;
  std::size_t dropDuplicates(std::vector<PoleDetection>& poles) const;
  void selectForFit(const SegmentCluster& stack);
  PoleFeatures describe(const SegmentCluster& stack, const ClusterShape& shape,
                        const CandidateFeatures& evidence, const PoleAxis& axis) const;
  double covarianceScale(const PoleFeatures& features, double odds) const;

  SensorOptions m_sensorOptions;
  ScanLineOptions m_options;
  Eigen::Vector2f m_upright = Eigen::Vector2f::Zero();
  float m_farthest;  ///< m
  SensorModel m_sensor;
  ScanLines m_lines;
  GroundGrid m_ground;
  ScanLineSegmenter m_finder;
  SegmentClustering m_stacker;
  VisibilityRangeFinder m_freeFinder;
  std::vector<float> m_freeRange;
  std::vector<ScanLineSegment> m_slices;
  std::vector<std::uint32_t> m_fitSlices;
  std::vector<float> m_widths;
  std::vector<PoleTilt> m_leans;  ///< of the poles found, in the order they were found
};

}  // namespace polemcl
