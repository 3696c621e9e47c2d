#pragma once
/// \file ScanLineExtractor.h
/// \brief The native method, A to B3, on one screen. Private to the library; see PoleExtractor.h.

#include "core/extraction/ExtractionOptions.h"
#include "core/extraction/ExtractionReport.h"
#include "core/extraction/PoleClassifier.h"
#include "core/extraction/VisibilityRange.h"
#include "core/extraction/scan_line/CandidateFeatures.h"
#include "core/sensor/PinholeCamera.h"
#include "core/sensor/SensorOptions.h"

namespace polemcl {

class NativeExtractor {
 public:
  /// \param model Made from the same options, or from a depth camera.
  NativeExtractor(SensorModel model, const SensorOptions& sensor, const NativeOptions& options);
  /// \param upright See PoleExtractor::extract().
  void extract(const PointsView& points, const Eigen::Vector2f& upright,
               std::vector<PoleDetection>& poles, ExtractionReport& report);
  /// \brief Of the last scan, as FreeRangeFinder gives it.
  const std::vector<float>& freeRange() const { return m_freeRange; }

 private:
  /// \return The reason of the refusal, or Refusal::count_ when `pole` and `lean` were filled.
  Refusal examine(const Stack& stack, PoleDetection& pole, PoleLean& lean);
  void setUpright(std::vector<PoleDetection>& poles) const;
  Refusal judgeShape(const Stack& stack, StackShape& shape) const;
  std::size_t dropDuplicates(std::vector<PoleDetection>& poles) const;
  void selectForFit(const Stack& stack);
  PoleFeatures describe(const Stack& stack, const StackShape& shape, const PoleEvidence& evidence,
                        const PoleAxis& axis) const;
  double covarianceScale(const PoleFeatures& features, double odds) const;

  SensorOptions m_sensorOptions;
  NativeOptions m_options;
  Eigen::Vector2f m_upright = Eigen::Vector2f::Zero();
  float m_farthest;  ///< m
  SensorModel m_sensor;
  ScanLines m_lines;
  GroundGrid m_ground;
  SliceFinder m_finder;
  SliceStacker m_stacker;
  FreeRangeFinder m_freeFinder;
  std::vector<float> m_freeRange;
  std::vector<Slice> m_slices;
  std::vector<std::uint32_t> m_fitSlices;
  std::vector<float> m_widths;
  std::vector<PoleLean> m_leans;  ///< of the poles found, in the order they were found
};

}  // namespace polemcl
