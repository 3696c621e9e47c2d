#pragma once
/// \file RawlogWriter.h
/// \brief Writes rawlogs, uncompressed. They have a temporary name until they are complete.
/// Motions the way they keep them; positions from satellites between the scans.

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <optional>
#include <string>
#include <vector>

#include "io/data/PlanarMotion.h"
#include "io/file/AtomicFile.h"

namespace polemcl {

/// \brief The motion up to a scan as the action before it: one `CActionRobotMovement2D` with
/// `emScan2DMatching` (the default, `emOdometry`, does not store `poseChange`) and a
/// `CPosePDFGaussian`. No motion: an empty collection.
mrpt::obs::CActionCollection makeActions(const std::optional<PoseWithCovariance>& motion,
                                         const mrpt::Clock::time_point& stamp);

/// \brief Identity, the motion before the first scan: with the least deviations that a motion has
/// in rawlogs, since filters want a positive definite covariance.
PoseWithCovariance standstill();

/// \brief Writer of one rawlog. If it is destroyed before commit(), no file remains.
class RawlogWriter {
 public:
  /// \throws Error when the folder cannot be written.
  explicit RawlogWriter(const std::string& path);

  /// \brief Writes the comment of the rawlog, as MRPT's own; to be called first.
  /// \param time Of the first scan, s: MRPT's tools cut rawlogs by the times of all objects.
  void writeComment(const std::string& text, double time);
  /// \brief Writes an action and a sensory frame with the observation.
  /// \throws Error when an action's movement would be lost: CActionRobotMovement2D with
  ///         `emOdometry` stores the odometry reading, not `poseChange`.
  void write(const mrpt::obs::CActionCollection& action,
             const mrpt::obs::CObservation::Ptr& observation);
  /// \brief Writes a single observation.
  void write(const mrpt::obs::CObservation& observation) { writeObject(observation); }
  /// \brief Gives the file its name. \throws Error when a write failed (disk full).
  void commit() { m_file.commit(); }

 private:
  void writeObject(const mrpt::serialization::CSerializable& object);

  io::AtomicFile m_file;
};

/// \brief Writes each observation as a single one before the first scan that is later.
class GnssWriter {
 public:
  /// \param rawlog Where the scans are written as well; must outlive this.
  /// \param observations In the order of their times.
  GnssWriter(RawlogWriter& rawlog, std::vector<mrpt::obs::CObservationGPS::Ptr> observations);

  /// \brief To be called before the action of each scan.
  void writeBefore(mrpt::system::TTimeStamp scan);
  /// \brief To be called after the last scan: writes what is left.
  void writeRest();

 private:
  RawlogWriter& m_rawlog;
  std::vector<mrpt::obs::CObservationGPS::Ptr> m_observations;
  std::size_t m_next = 0;
};

}  // namespace polemcl
