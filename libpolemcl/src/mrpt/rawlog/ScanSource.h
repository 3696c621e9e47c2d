#pragma once
/// \file ScanSource.h
/// \brief The scans of a rawlog in order, each with the motion since the one before.

#include <mrpt/obs/CActionCollection.h>

#include <deque>
#include <exception>
#include <optional>
#include <string>

#include "io/data/PlanarMotion.h"
#include "mrpt/rawlog/MotionOptions.h"
#include "mrpt/rawlog/OdometryTrack.h"
#include "mrpt/rawlog/RawlogReader.h"

namespace polemcl {

/// \brief The planar motion an action estimates; none when it holds no movement.
/// \throws Error when it is not finite or its covariance is not positive semidefinite.
std::optional<io::PlanarMotion> motionOf(const mrpt::obs::CActionCollection& actions,
                                         const MotionOptions& options);

/// \brief Reads scans, not yet their points.
class ScanSource {
 public:
  struct Scan {
    std::size_t index = 0;  ///< 0-based
    double time = 0;        ///< s
    std::optional<io::PlanarMotion> motion;
    mrpt::obs::CObservation::Ptr observation;
  };
  ScanSource(const std::string& path, const MotionOptions& motion, bool allowTruncated);

  /// \brief The next scan, none at the end. \throws Error as RawlogReader, and naming the scan.
  std::optional<Scan> next();

  std::size_t otherSensors() const { return m_otherSensors; }
  std::size_t unknownMotions() const { return m_unknownMotions; }
  bool truncated() const { return m_reader.truncated(); }
  /// \brief Scans of the whole file, judged from those in the share read so far; 0: not known.
  std::size_t expected() const;

 private:
  void take(const RawlogEntry& entry);
  void take(const mrpt::obs::CObservation::Ptr& observation);
  bool mustWait(const Scan& scan) const;
  Scan release();

  std::string m_path;
  MotionOptions m_options;
  RawlogReader m_reader;
  std::optional<io::PlanarMotion> m_moved;  ///< by actions, since the last scan
  OdometryTrack m_odometry;
  std::deque<Scan> m_waiting;  ///< for odometry later than they are
  std::string m_sensor;        ///< class and label of the scans that are used; empty: none yet
  double m_lastTime = 0;       ///< of the scan released last
  std::exception_ptr m_error;  ///< why the reading ended
  bool m_ended = false, m_anyAction = false;
  std::size_t m_scans = 0, m_released = 0, m_otherSensors = 0, m_unknownMotions = 0;
};

}  // namespace polemcl
