#pragma once
/// \file DetectionEvaluation.h
/// \brief How good the poles of single scans are, against poles known to stand there, and which of
/// these a scan shows.

#include <Eigen/Geometry>
#include <cstdint>
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

/// \brief A pole that stands in the world, map frame.
struct WorldPole {
  std::uint32_t id = 0;  ///< label of its points
  double x = 0, y = 0;   ///< of its axis, m
  double radius = 0;     ///< m
  double top = 0;        ///< m above ground
};

/// \brief A pole is visible when at least `returns` returns carry its id, the highest is at least
/// `height` above the lowest, and the sensor is not farther away than `range`.
struct VisibilityRule {
  std::size_t returns = 6;
  double height = 0.6;  ///< m
  double range = 40;    ///< in the plane, m
};

/// \brief What one scan shows of one pole.
struct PoleSight {
  std::size_t returns = 0;         ///< that carry its id
  double lowest = 0, highest = 0;  ///< of these, map frame, m; without any the sensor's height
  double sensor = 0;               ///< height of the cloud's origin, map frame, m
  double range = 0;                ///< from the origin of the cloud, in the plane of the map, m
  bool visible = false;
};

/// \brief What a scan shows of each pole, in the order of `poles`.
/// \param points In the cloud frame.
/// \param labels One per point; a pole's returns carry exactly its id. Foliage of the simulator has
///        another bit set, so it does not count.
/// \throws Error when the numbers of points and labels differ, or two poles have one id.
std::vector<PoleSight> sightPoles(const PointsView& points,
                                  const std::vector<std::uint32_t>& labels,
                                  const Eigen::Isometry3d& T_map_cloud,
                                  const std::vector<WorldPole>& poles,
                                  const VisibilityRule& rule = {});

/// \brief The poles where a perfect extractor would see them: axes are upright in the map, not in
/// the frame of a sensor that leans with the road, so each is taken at the height of the sensor,
/// where leaning does not move it.
/// \param T_scan_map From the map to the frame of the detections.
std::vector<TruePoleInScan> polesInScan(const std::vector<WorldPole>& poles,
                                        const std::vector<PoleSight>& sights,
                                        const Eigen::Isometry3d& T_scan_map);

}  // namespace polemcl
