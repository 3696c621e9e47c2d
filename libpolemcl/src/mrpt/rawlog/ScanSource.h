#pragma once
/// \file ScanSource.h
/// \brief The scans of a rawlog in order, each with the motion since the previous one.

#include <mrpt/obs/CActionCollection.h>

#include <cmath>
#include <deque>
#include <exception>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <polemcl/core/sensor/SensorOptions.h>
#include "core/common/Deskew.h"
#include "io/data/PlanarMotion.h"
#include "mrpt/rawlog/EntrySource.h"
#include "mrpt/rawlog/MotionOptions.h"
#include "mrpt/rawlog/OdometryTrack.h"
#include "mrpt/rawlog/ScanGroups.h"

namespace polemcl {

/// \brief Whether it is a scan: one with poles, or one that poles can be extracted from.
bool isScan(const mrpt::obs::CObservation& observation);

/// \brief The planar motion in an action; nullopt when it holds no movement.
/// \throws Error when it is not finite or its covariance is not positive semidefinite.
std::optional<PoseWithCovariance> motionOf(const mrpt::obs::CActionCollection& actions,
                                           const MotionOptions& options);

/// \brief Reads scans without loading their points.
class ScanSource {
 public:
  struct Scan {
    std::size_t index = 0;  ///< 0-based
    double time = 0;        ///< s
    std::optional<PoseWithCovariance> motion;
    std::optional<Velocity> velocity = {};  ///< see ReadScan
    std::optional<Velocity> moving = {};    ///< best guess of the velocity at that time
    std::vector<LidarScan> parts;           ///< at least one; in the order of the LiDARs
    bool isFused = false;                   ///< the parts are to be fused
    std::optional<std::chrono::steady_clock::time_point> arrival;  ///< as in RawlogEntry
    std::size_t dropped = 0;  ///< scans of sensors that were dropped before it, in all
  };
  /// \brief Also sets the base folder of external files with relative names in MRPT: the folder
  /// that MRPT's tools use (`<rawlog>_Images`) if it exists, otherwise the folder of the rawlog.
  ScanSource(const std::string& path, const MotionOptions& motion, bool allowTruncated,
             double follow = 0, const VehicleOptions& vehicle = {});
  /// \brief From any source. \param name For messages.
  ScanSource(std::shared_ptr<EntrySource> entries, std::string name, const MotionOptions& motion,
             const VehicleOptions& vehicle = {});

  /// \brief The next scan; nullopt at the end. Sensors: waits for it; a scan without odometry is
  /// left out, and the motion goes on to the next one.
  /// \throws Error as RawlogReader, with the scan; when no odometry came with many scans of
  /// sensors, or a rawlog has no scan of a LiDAR of the vehicle.
  std::optional<Scan> next();

  /// \brief As EntrySource::stop().
  void stop() { m_entries->stop(); }

  /// \brief Measuring times of the scans, if the comment of the rawlog states them.
  const ScanTiming& timing() const { return m_timing; }
  std::size_t otherSensors() const { return m_otherSensors; }
  const std::set<std::string>& otherLabels() const { return m_otherLabels; }
  /// \brief Labels of odometry that is not used: that of another sensor came first.
  const std::set<std::string>& otherOdometry() const { return m_otherOdometry; }
  /// \brief Whether the scans are those of LiDARs to be fused.
  bool isFused() const { return m_groups.has_value(); }
  /// \brief Scans of a LiDAR that came too late.
  std::size_t late(std::size_t lidar) const { return m_late[lidar]; }
  std::size_t unknownMotions() const { return m_unknownMotions; }
  /// \brief Jumps of the odometry so far, see OdometryTrack.
  std::size_t odometryJumps() const { return m_odometry.jumps(); }
  bool isLive() const { return m_entries->isLive(); }
  std::size_t dropped() const { return m_entries->dropped(); }
  bool truncated() const { return m_entries->truncated(); }
  /// \brief Estimated number of scans in the file, from the fraction read so far; 0: unknown.
  std::size_t expected() const;

 private:
  void take(const RawlogEntry& entry);
  void take(const mrpt::obs::CObservation::Ptr& observation, const RawlogEntry& entry);
  std::optional<std::size_t> lidarOf(const mrpt::obs::CObservation& observation);
  void add(LidarScan scan);
  void takeGroups();
  void requireLidars() const;
  bool fill();
  bool isLeftOut(const Scan& scan);
  bool mustWait(const Scan& scan) const;
  Scan release();
  std::optional<Velocity> velocityAt(const Scan& scan) const;

  std::string m_name;
  MotionOptions m_options;
  std::shared_ptr<EntrySource> m_entries;
  std::optional<PoseWithCovariance> m_moved;  ///< motion by actions since the last scan
  OdometryTrack m_odometry;
  std::string m_odometryLabel;        ///< of the sensor whose readings are used
  double m_lastOdometry = -INFINITY;  ///< time of its last reading, s
  ScanTiming m_timing;
  std::deque<Scan> m_waiting;  ///< scans waiting for later odometry
  std::string m_sensor;        ///< class and label of the scans in use; empty before the first
  double m_lastTime = 0;       ///< time of the last scan released
  std::exception_ptr m_error;  ///< reason why reading ended
  bool m_ended = false;
  const VehicleOptions m_vehicle;
  std::optional<ScanGroups> m_groups;          ///< of several LiDARs; not for poles fused before
  std::vector<std::size_t> m_ofLidar, m_late;  ///< scans of each LiDAR: all, and those too late
  std::set<std::string> m_otherLabels, m_otherOdometry;
  mrpt::obs::CObservation::Ptr m_planar;  ///< the first scan of one plane only
  std::size_t m_motions = 0;              ///< by actions, so far
  std::size_t m_scans = 0, m_released = 0, m_otherSensors = 0, m_unknownMotions = 0;
};

}  // namespace polemcl
