#pragma once
/// \file LiveMoment.h
/// \brief All that a picture of a running localization shows, at one moment, and what is kept of it
/// to be shown again.

#include <mrpt/math/TPoint3D.h>
#include <mrpt/obs/CObservation.h>

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "core/localization/MapAssociation.h"
#include "mrpt/filter/LocalizationPipeline.h"
#include "mrpt/rawlog/PoleSequence.h"

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

/// \brief The moments of a run: the newest whole, older ones without points and with few
/// particles.
///
/// A scan takes some 0.5 kB, 24 bytes a pole and 12 bytes a particle: 2 kB with 20 poles. Of a long
/// drive only the last `mostScans` are kept, some 200 MB.
class KeptMoments {
 public:
  static constexpr std::size_t mostScans = 100000;   ///< 2.8 h at 10 Hz
  static constexpr std::size_t mostParticles = 100;  ///< of a moment before the newest
  static constexpr std::size_t mostHypotheses = 10;  ///< of a moment before the newest

  /// \brief Moments must come in order, one for each scan. Their ways are made here.
  void add(LiveMoment moment);
  std::size_t oldest() const { return m_newest.scan + 1 - m_kept.size(); }
  /// \brief With ways. \param scan From oldest() to the newest.
  LiveMoment at(std::size_t scan) const;
  /// \brief Of the position, m, at each scan so far; negative where it is not known.
  const std::vector<float>& errors() const { return m_errors; }

 private:
  struct Pole {
    float x, y, radius, bottom, top;  ///< robot frame, m
    bool matched;
  };
  struct Particle {
    float x, y;  ///< from the estimate, axes of the map, m
    float weight;
  };
  struct Kept {
    double elapsed = 0;
    std::optional<PoseWithCovariance> estimate;
    std::optional<Pose2D> truth;
    Health health;
    StepReport step;
    bool relocalized = false, associated = false;
    std::vector<Pole> poles;
    std::vector<Particle> particles;
    std::vector<GlobalHypothesis> hypotheses;
  };
  static Kept kept(const LiveMoment& moment);
  static LiveMoment restored(const Kept& kept);

  LiveMoment m_newest;
  std::deque<Kept> m_kept;  ///< the last one is the newest
  std::vector<float> m_errors;
  Way m_way, m_trueWay;
};

/// \brief Robot frame, without points that are no returns; at most 50000, evenly chosen.
/// \param sources Of one scan, as in ReadScan. \param reading As the scan was read.
/// \throws Error as ObservationPoints::read().
std::vector<mrpt::math::TPoint3Df> scanPoints(
    const std::vector<mrpt::obs::CObservation::Ptr>& sources, const SequenceOptions& reading);

}  // namespace polemcl::report
