#pragma once
/// \file ScanLineExtractor.h
/// \brief The scan-line method, A to B3, on one screen. Private to the library; see
/// PoleExtractor.h.

#include <optional>

#include <polemcl/core/extraction/ExtractionOptions.h>
#include <polemcl/core/extraction/ExtractionReport.h>
#include <polemcl/core/sensor/SensorOptions.h>
#include "core/extraction/PoleClassifier.h"
#include "core/extraction/VisibilityRange.h"
#include "core/extraction/scan_line/CandidateFeatures.h"
#include "core/sensor/PinholeCamera.h"

namespace polemcl {

/// \brief A candidate with all that the classifier and the covariance are fitted on.
struct PoleCandidate {
  PoleFeatures features;
  double x = 0, y = 0;         ///< along its own tilt, frame of the points, m
  Eigen::Matrix2d covariance;  ///< of the fit alone, m²
  PoleTilt tilt;
};

class ScanLineExtractor {
 public:
  /// \param model Made from the same options, or from a depth camera.
  ScanLineExtractor(SensorModel model, const SensorOptions& sensor, const ScanLineOptions& options);
  /// \param upright See PoleExtractor::extract().
  void extract(const PointsView& points, const Eigen::Vector2f& upright,
               std::vector<PoleDetection>& poles, ExtractionReport& report);
  /// \brief For training: extract() replaces the contents of `candidates` by all candidates that a
  /// circle fits, however low their odds; no weight of the classifier changes them. Null (the
  /// default): none, and no work for it.
  void recordCandidates(std::vector<PoleCandidate>* candidates) { m_recorded = candidates; }
  /// \brief Visibility ranges of the last scan, as VisibilityRangeFinder gives them.
  const std::vector<float>& visibilityRange() const { return m_visibilityRange; }

 private:
  /// \return Why the cluster is rejected; nothing when `pole` and `tilt` were filled.
  std::optional<RejectionReason> examine(const SegmentCluster& cluster, PoleDetection& pole,
                                         PoleTilt& tilt);
  void setUpright(std::vector<PoleDetection>& poles) const;
  void record(const SegmentCluster& cluster, PoleFeatures features, const PoleAxis& axis,
              const PoleFit& fit);
  std::optional<RejectionReason> judgeShape(const SegmentCluster& cluster,
                                            ClusterShape& shape) const;
  std::size_t dropDuplicates(std::vector<PoleDetection>& poles) const;
  void selectForFit(const SegmentCluster& cluster);
  PoleFeatures describe(const SegmentCluster& cluster, const ClusterShape& shape,
                        const CandidateFeatures& candidate, const PoleAxis& axis) const;

  SensorOptions m_sensorOptions;
  ScanLineOptions m_options;
  Eigen::Vector2f m_upright = Eigen::Vector2f::Zero();
  float m_farthest;  ///< m
  SensorModel m_sensor;
  ScanLines m_lines;
  GroundGrid m_ground;
  ScanLineSegmenter m_finder;
  SegmentClustering m_clustering;
  VisibilityRangeFinder m_visibilityFinder;
  std::vector<float> m_visibilityRange;
  std::vector<ScanLineSegment> m_segments;
  std::vector<std::uint32_t> m_fitSegments;
  std::vector<float> m_widths;
  std::vector<PoleTilt> m_tilts;  ///< of the poles found, in the order they were found
  std::vector<PoleCandidate>* m_recorded = nullptr;
};

}  // namespace polemcl
