#pragma once
/// \file LiveMoment.h
/// \brief All that a picture of a running localization shows, at one moment.

#include <mrpt/math/TPoint3D.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "core/localization/MapAssociation.h"
#include "mrpt/filter/LocalizationPipeline.h"

namespace polemcl::report {

/// \brief A place the estimate, or the truth, has been at, map frame, m.
struct WayPoint {
  double x = 0;
  double y = 0;
  bool joined = false;  ///< false: it jumped here, no line leads from the point before
  HealthState state = HealthState::ok;  ///< the worst since the point before
  std::size_t scan = 0;                 ///< 0-based, as counted by the way
};

/// \brief The places of a run, thinned as they come: a long drive stays drawable.
class Way {
 public:
  static constexpr double spacing = 1.0;  ///< least distance between two points but the last, m
  /// \brief One update more; without an estimate the line is broken.
  void add(const LocalizationUpdate& update);
  /// \brief The same for any pose. \param jumped No line leads here.
  void add(const std::optional<Pose2D>& pose, bool jumped, HealthState state = HealthState::ok);
  const std::vector<WayPoint>& points() const { return m_points; }
  /// \brief As it was after this scan, at which pose and state were these.
  std::vector<WayPoint> until(std::size_t scan, const std::optional<Pose2D>& pose,
                              HealthState state = HealthState::ok) const;

 private:
  std::vector<WayPoint> m_points;
  std::size_t m_scans = 0;
  HealthState m_worst = HealthState::ok;  ///< since the last point that stays
  bool m_broken = true;                   ///< the next point begins a line
  bool m_provisional = false;             ///< the last point is too near to the one before to stay
};

/// \brief A copy: the localization may go on while it is drawn.
struct LiveMoment {
  std::size_t scan = 0;                        ///< 0-based index in the input
  double elapsed = 0;                          ///< since the first scan, s
  std::optional<PoseWithCovariance> estimate;  ///< map frame
  std::vector<Pose2D> particles;               ///< map frame; empty without a pose
  std::vector<double> weights;                 ///< of the particles, the greatest is 1
  std::vector<PoleDetection> poles_robot;      ///< observed in this scan
  std::vector<PoleMatch> matches;              ///< of the observed poles; empty without a pose
  std::vector<GlobalHypothesis> hypotheses;    ///< of the last search, while the pose is in doubt
  Health health;
  StepReport step;
  bool relocalized = false;
  std::vector<WayPoint> way;                        ///< up to here
  std::optional<Pose2D> truth;                      ///< map frame; nothing without truth
  std::vector<WayPoint> trueWay;                    ///< up to here
  std::vector<mrpt::math::TPoint3Df> points_robot;  ///< of the scan, if they are to be seen
};

/// \brief Without ways, truth and points. \param start Time of the first scan, s.
LiveMoment momentOf(const LocalizationPipeline& localization, const PoleScan& frame,
                    const LocalizationUpdate& update, std::size_t scan, double start);

/// \brief Distance of the estimate from the truth, m; nothing without either.
std::optional<double> positionError(const LiveMoment& moment);

}  // namespace polemcl::report
