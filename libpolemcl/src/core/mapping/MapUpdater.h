#pragma once
/// \file MapUpdater.h
/// \brief Keeps a pole map true: one session of scans at known poses -> the map of the day after.
///
/// Each scan's detections go to the kept poles by gated distance, one detection a scan and pole,
/// nearest pairs first; what is left over is merged as buildPoleMap() does and becomes new poles.
/// Whether a pole stands is told by PoleExistence, from the scans that found it and those that
/// could have (in range and, by their visibility range, in view).

#include <cstddef>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/mapping/PoleMapBuilder.h>
#include <polemcl/export.h>
#include "core/common/Binder.h"
#include "core/mapping/PoleExistence.h"

namespace polemcl {

/// \brief `[map_update]` in INI files. Gates and pose errors are those of `[map]`.
struct POLEMCL_EXPORT MapUpdateOptions {
  double range = 20;  ///< a scan is expected to find poles in view up to here, m (`range_m`)
  int minSeen = 5;    ///< least number of scans that found a pole on the map
  /// Mean time that a pole stands, days (`lifetime_days`): its existence decays between sessions.
  double lifetimeDays = 3650;
  /// Standard deviation of one session's positions against those of others, m
  /// (`session_sigma_m`).
  double sessionSigma = 0.02;
  /// A pole that a session puts farther than this from its place, beyond its 99.9 % ellipse, has
  /// been moved, m (`moved_m`). Its place is the new one; nothing is averaged.
  double moved = 0.25;
  /// Standard deviation of the errors of a session's positions along an axis before it is aligned
  /// to the map, m (`align_sigma_m`); 0: sessions are taken as they are.
  double alignSigma = 0.2;
};

POLEMCL_EXPORT void bind(Binder& binder, MapUpdateOptions& options);  ///< `[map_update]`

/// \brief A pole of a kept map.
struct LandmarkRecord {
  MapPole pole;
  PoleHistory history;
  /// On the map; otherwise a candidate: a new one that has not earned its place, or one that faded.
  bool present = false;
};

/// \brief One scan of a session.
struct SessionScan {
  double time = 0;  ///< s since 1970
  Pose2D pose_map_robot;
  std::vector<PoleDetection> poles_robot;
  /// As CObservationPoles carries it. Empty: poles that this scan does not find are not missed.
  std::vector<float> visibilityRange;
  Pose2D pose_robot_sensor;  ///< of the frame of visibilityRange
  /// Covariance of pose_map_robot (x, y, yaw; m², m·rad, rad²), beyond `[map] pose_sigma_m` and
  /// `heading_sigma_deg`. Zero: a pose of the truth.
  Eigen::Matrix3d poseCovariance = Eigen::Matrix3d::Zero();
};

/// \brief What the alignment of one session to the map did.
struct AlignmentSummary {
  std::size_t scans = 0;    ///< scans in pieces with enough poles of the map
  double meanShift = 0;     ///< mean length of the corrections of these scans, m
  double largestShift = 0;  ///< m
  double largestTurn = 0;   ///< rad
};

/// \brief What a session changed.
struct MapUpdateCounts {
  std::size_t scans = 0;              ///< used
  std::size_t uncertain = 0;          ///< left out: their positions are too uncertain
  std::size_t withoutVisibility = 0;  ///< of the used ones: nothing is missed in them
  std::size_t expectedOnMap = 0;      ///< poles on the map before that a scan could see
  std::size_t nearOnMap = 0;          ///< poles that scans without visibility ranges passed nearby
  std::size_t foundOnMap = 0;         ///< of these two, found at least once
  std::size_t entered = 0;            ///< new on the map
  std::size_t left = 0;               ///< gone from the map, those moved a stride away not counted
  std::size_t moved = 0;              ///< in place, or a stride away
  std::size_t candidates = 0;         ///< kept beside the map
  std::size_t forgotten = 0;
  AlignmentSummary alignment;  ///< zero without alignment
};

/// \brief A map with what is known of its poles, sorted by x then y.
struct LandmarkMap {
  std::vector<LandmarkRecord> poles;
};

/// \brief Poles of a map without a history: they are on the map with existence 0.9, their `count`
/// stands for the scans that saw them, nothing is known of missed ones.
POLEMCL_EXPORT LandmarkMap landmarksFrom(const std::vector<MapPole>& poles);

/// \brief Histories for a map just built from the same scans: places stay as they are, and all of
/// it stays on the map, whatever the scans say.
POLEMCL_EXPORT LandmarkMap withHistory(const std::vector<MapPole>& poles,
                                       const std::vector<SessionScan>& scans,
                                       const PoleMapOptions& mapping,
                                       const MapUpdateOptions& options);

/// \brief Updates a map by one session, which is first aligned to it (`align_sigma_m`). Scans in
/// the order they were driven; the result does not depend on the order of the detections in a scan.
/// \param counts If given: what changed.
/// \throws Error on options out of range, on scans as buildPoleMap(), and on a visibility
///         range that is negative or not finite.
POLEMCL_EXPORT LandmarkMap updateMap(const LandmarkMap& map, const std::vector<SessionScan>& scans,
                                     const PoleMapOptions& mapping, const MapUpdateOptions& options,
                                     MapUpdateCounts* counts = nullptr);

/// \brief The poles that are on the map, in its order.
POLEMCL_EXPORT std::vector<MapPole> presentPoles(const LandmarkMap& map);

}  // namespace polemcl
