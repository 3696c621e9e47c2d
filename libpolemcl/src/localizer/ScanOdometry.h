#pragma once
/// \file ScanOdometry.h
/// \brief Motions between scans, from odometry that is read at other times.

#include <cmath>
#include <optional>

#include <polemcl/localizer/Localizer.h>
#include "io/data/PlanarMotion.h"
#include "mrpt/rawlog/MotionOptions.h"
#include "mrpt/rawlog/OdometryTrack.h"

namespace polemcl {

/// \brief Collects readings, and tells the motion from one scan to the next.
class ScanOdometry {
 public:
  explicit ScanOdometry(const MotionOptions& options) : m_options(options) {}

  /// \brief A reading not later than the last one is left out; after a second of such readings the
  /// odometry begins anew, or when one is a jump from the last one but goes on from those left out.
  /// \throws Error unless time and pose are finite.
  void add(const OdometryReading& reading);
  /// \brief A drive begins: no motion leads to its first scan, and its times may begin anew.
  void restart();
  /// \brief The odometry at a scan, which is not kept: the scan may be refused. \throws Error
  /// unless finite.
  Pose2D atScan(double time, const Pose2D& pose) const;
  /// \brief Keeps it.
  void addAtScan(double time, const Pose2D& pose);
  const OdometryTrack& track() const { return m_track; }
  /// \brief As the last reading of add() stated it.
  std::optional<Velocity> velocity() const;

  /// \brief The motion since the scan before; none at the first. \param time Of the scan as the
  /// odometry counts it: observations round theirs. \param pose Of the track at that time.
  std::optional<PoseWithCovariance> motionTo(double time, const Pose2D& pose) const;
  /// \brief Ends a scan: the next motion begins here.
  void pass(double time, const Pose2D& pose);

 private:
  bool continuesLate(const OdometryReading& next) const;
  void beginAnew();

  MotionOptions m_options;
  OdometryTrack m_track;
  io::MotionSteps m_steps;                   ///< between the readings whose covariance is known
  std::optional<OdometryReading> m_reading;  ///< the last one; its pose is that of the track
  std::optional<double> m_lateSince;         ///< first of the readings now left out, s
  std::optional<OdometryReading> m_late;     ///< the last of them
  std::optional<Pose2D> m_before;            ///< at the last scan
  double m_timeBefore = -INFINITY;           ///< of the last scan, s
};

}  // namespace polemcl
