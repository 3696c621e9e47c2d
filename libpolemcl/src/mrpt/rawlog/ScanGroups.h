#pragma once
/// \file ScanGroups.h
/// \brief Which scans of several LiDARs belong together.

#include <mrpt/obs/CObservation.h>

#include <chrono>
#include <deque>
#include <optional>
#include <vector>

#include "io/data/PlanarMotion.h"
#include "mrpt/rawlog/VehicleOptions.h"

namespace polemcl {

/// \brief A scan of one LiDAR of a vehicle.
struct LidarScan {
  mrpt::obs::CObservation::Ptr observation;
  std::size_t lidar = 0;    ///< index in VehicleOptions::lidars; 0 if none are named
  double time = 0;          ///< s, in the clock of the odometry
  std::size_t ordinal = 0;  ///< 0-based among the scans of this LiDAR
  std::size_t motions = 0;  ///< number of motions by actions before it; 0: none
  std::optional<PoseWithCovariance> motion = {};  ///< by actions, since the scan read before it
  std::optional<std::chrono::steady_clock::time_point> arrival = {};  ///< as in RawlogEntry
};

/// \brief Groups scans by their times. A group starts with the earliest scan that waits. The next
/// ones by time belong to it while they are of other LiDARs, and come within
/// VehicleOptions::fuseWithin of the first, or no motion by an action is between them: odometry
/// does not tell them apart then.
///
/// A group is complete when each LiDAR has a scan in it or a later one, or when any scan has come
/// from VehicleOptions::fuseWithin plus VehicleOptions::wait after its first: a LiDAR that misses a
/// scan does not hold up the others for longer. (Odometry tells nothing here: it may come long
/// before the scans of its time.) The result depends on the order of the calls only.
class ScanGroups {
 public:
  explicit ScanGroups(const VehicleOptions& vehicle);

  /// \return false: the scan is older than the last group, so it comes too late and is dropped.
  bool add(LidarScan scan);
  /// \brief The next complete group in the order of arrival; empty: none yet.
  /// \param ended Nothing will come: what waits is complete.
  std::vector<LidarScan> next(bool ended);

 private:
  std::size_t leading() const;
  bool canStillCome(std::size_t lidar, double first) const;
  bool isComplete(std::size_t count) const;

  struct Waiting {
    LidarScan scan;
    std::size_t arrived;  ///< number among all scans
  };
  const double m_within, m_wait;
  std::vector<std::optional<double>> m_latest;  ///< time of the latest scan by LiDAR, s
  std::deque<Waiting> m_waiting;                ///< in the order of their times
  std::optional<double> m_reached;              ///< time of the latest scan, s
  std::optional<double> m_given;                ///< time of the last scan given out, s
  std::size_t m_arrived = 0;
};

}  // namespace polemcl
