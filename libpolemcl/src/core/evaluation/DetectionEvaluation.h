#pragma once
/// \file DetectionEvaluation.h
/// \brief How good the poles of single scans are, against poles known to stand there.

#include <optional>
#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief A pole that stands there, in the frame of a scan's detections.
struct TruePoleInScan {
  double x = 0, y = 0;   ///< of its axis, m
  double radius = 0;     ///< m
  bool visible = false;  ///< the scan shows enough of it to be found
};

/// \brief Figures over scans. "Right" detections lie within the matching radius of a true pole,
/// *visible or not*, one to one (greedyAssignment()): who finds a pole behind two returns is not
/// wrong. Recall is of the visible ones only. A figure without data stays empty.
struct DetectionScore {
  std::size_t scans = 0, detections = 0;
  std::size_t right = 0;    ///< detections that are true poles
  std::size_t visible = 0;  ///< true poles visible, summed over scans
  std::size_t found = 0;    ///< of these, matched by a detection
  std::optional<double> precision, recall;

  // Figures of all right detections. Errors are detection minus truth.
  std::optional<double> centreMean, centreMedian, centre90;  ///< distance; 90 % are nearer, m
  std::optional<double> radiusMean;                          ///< signed, m
  std::optional<double> radiusMedian;                        ///< of the absolute error, m
  std::optional<double> neesMean, neesMedian;  ///< e'C⁻¹e, normalised squared error: 2 and 1.39
  /// Mean error along the ray from the origin to the pole, + beyond it, and across, + left, m.
  std::optional<double> biasAlong, biasAcross;
  /// Area under the ROC of the confidence: the chance that a right detection has more than a wrong
  /// one, equal confidences counting half.
  std::optional<double> auc;
};

/// \brief Collects scans, then sums up.
class DetectionEvaluation {
 public:
  /// \param radius Matching radius, m. \throws Error unless finite and positive.
  explicit DetectionEvaluation(double radius = 0.5);

  /// \brief One scan. Both in one frame whose origin is the sensor's.
  /// \throws Error when a coordinate is not finite or a covariance is not positive definite.
  void add(const std::vector<PoleDetection>& detections, const std::vector<TruePoleInScan>& truth);
  DetectionScore score() const;

 private:
  void addRight(const PoleDetection& detection, const TruePoleInScan& truth);

  double m_radius;
  std::size_t m_scans = 0, m_visible = 0, m_found = 0;
  std::vector<double> m_centre, m_radiusError, m_nees, m_along, m_across;  ///< of right detections
  std::vector<double> m_rightConfidence, m_wrongConfidence;
};

}  // namespace polemcl
