#pragma once
/// \file MapAccumulator.h
/// \brief A map from sessions one after the other, by the paper's protocol: the first is used
/// whole, later ones where nobody has been (`[map] unvisited_m`).
///
/// The map after n sessions is the same, to the last bit, whether they are added in one run or each
/// on the day it was driven: what was added is kept, and can be stored (`.polemap`, chunk `SCAN`).

#include <string>
#include <vector>

#include "core/mapping/MapUpdater.h"

namespace polemcl {

/// \brief A session as a map remembers it.
struct AddedSession {
  std::string name;
  /// Scans in the order driven. A scan that is not used keeps only its time and pose.
  std::vector<SessionScan> scans;
  std::vector<bool> used;  ///< one a scan
  /// Covariance of the pose of each scan (x, y, yaw; m², m·rad, rad²), relative to the first pose
  /// of the map. Empty if the poses are true ones.
  std::vector<Eigen::Matrix3d> covariances = {};
  std::size_t usedCount() const;
  /// \brief Share of the scans that are used (`f_map`), 0 without a scan.
  double usedShare() const;
};

/// \brief Everything that was added, in that order.
struct AddedSessions {
  double unvisited = 0;  ///< m, as PoleMapOptions: what chose the scans that are used
  std::vector<AddedSession> sessions;
  std::size_t scans() const;  ///< of all sessions, used or not
};

/// \brief Sessions -> a map with histories.
class MapAccumulator {
 public:
  /// \throws Error on options out of range.
  MapAccumulator(const PoleMapOptions& mapping, const MapUpdateOptions& upkeep);
  /// \brief Goes on after sessions added before. Their scans are used as they are; all other
  /// options may have changed since. \throws Error when they were chosen by another `unvisited`:
  /// what was left out then is lost.
  MapAccumulator(const PoleMapOptions& mapping, const MapUpdateOptions& upkeep,
                 AddedSessions before);

  /// \brief The next session. Its scans are used unless a scan of an earlier session, used or not,
  /// stood within `unvisited` of them. The session itself does not count, so loops of it are used.
  /// \param scans In the order driven. \param covariances As in AddedSession.
  /// \return The session with what is kept of it; valid until the next call.
  /// \throws Error naming session and scan for a pose that is not finite; for a session more than
  /// 10 km from all before, which is in another frame.
  const AddedSession& add(std::string name, std::vector<SessionScan> scans,
                          std::vector<Eigen::Matrix3d> covariances = {});

  /// \brief buildPoleMap() on the scans used. \throws Error as buildPoleMap().
  PoleMapResult build() const;
  /// \brief withHistory() by the scans used.
  LandmarkMap withHistories(const std::vector<MapPole>& poles) const;
  const AddedSessions& added() const { return m_added; }

 private:
  PoleMapOptions m_mapping;
  MapUpdateOptions m_upkeep;
  AddedSessions m_added;
};

}  // namespace polemcl
