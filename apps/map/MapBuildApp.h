#pragma once
/// \file MapBuildApp.h
/// \brief `pole-map build`: scans or poles, at true poses or with odometry -> a pole map.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/evaluation/MotionCheck.h"
#include "core/mapping/DriveAdjustment.h"
#include "core/mapping/MapAccumulator.h"
#include "core/slam/DriveMapping.h"
#include "map/MappingSession.h"

namespace polemcl::apps {

/// \brief Files of `pole-map build`.
struct MapBuildJob : MappingJob {
  /// `.polemap` that keeps its scans: the inputs are sessions after those it was made from.
  std::optional<std::filesystem::path> add = {};
  bool keepScans = false;  ///< in the map, for `add`; always with `add`, never with `inventory`
  /// `.polemap` of poles known to metres (`pole-map import`): the inputs are localized in it, and
  /// are adjusted to it together. Its poles out of their sight stay on the map.
  std::optional<std::filesystem::path> inventory = {};
  /// \name Without poses: those that were found
  /// @{
  std::vector<std::filesystem::path> gnss = {};  ///< CSV of fixes, one per input, or none
  bool gnssOfRawlogs = true;                     ///< without `gnss`: use those in the inputs
  std::vector<std::filesystem::path> trajectories = {};  ///< TUM, one per input, or none
  std::optional<std::filesystem::path> png = {};         ///< map, paths and loops, when given
  /// @}
};

/// \brief How the drives fit an inventory.
struct InventoryAdjustment {
  AdjustedDrives drives;
  std::size_t kept = 0;  ///< poles of the inventory that no drive came near
};

/// \brief What mapping did, summed over the inputs.
struct MapBuildSummary {
  std::size_t scans = 0;              ///< used
  std::size_t visited = 0;            ///< scans at true poses, used or not
  std::vector<FilledMotions> filled;  ///< of each input, where poses come from odometry
  SkippedScans skipped;
  PoleMapOptions mapping;
  PoleMapResult map;
  /// \brief How much of a session is in the map.
  struct Session {
    std::string name;                 ///< of the rawlog
    std::size_t scans = 0, used = 0;  ///< at true poses; of these
    double share = 0;                 ///< used / scans, `f_map`
  };
  std::vector<Session> sessions;                 ///< in their order, those of `add` first
  std::optional<InventoryAdjustment> inventory;  ///< when one was given
  std::optional<MappedDrives> mapped;            ///< when odometry stood for poses
  /// Number of positions from satellites left out of each input, as scans are too far apart.
  std::vector<std::size_t> fixesApart;
  std::vector<MotionCheck> motions;  ///< of each input, when its poses are a truth
  std::vector<std::string> doubts;   ///< sentences on inputs whose timing or mounting looks wrong
  std::size_t twins = 0;             ///< poles with another nearer than 1 m
};

/// \brief Builds the map, with a history of each pole for later updates, and writes the files of
/// the job. The inputs are sessions, in their order: see MapAccumulator for which scans are used.
/// The map's info holds `f_map.NAME` for each, NAME the rawlog's without its ending. The truth is
/// interpolated at the time of each scan, not across gaps of more than 2 s.
/// \param progress Progress of the current input; may be empty.
/// \throws Error as readPoleSequence() and readTum(); when the truth covers less than half of the
///         scans of an input; when no scan is usable; when no pole was found (names the section
///         length, the scan spacing and the counts); when an input has the scans of another, or of
///         `add`; when `add` keeps no scans, or ones chosen by another `unvisited_m`, or has
///         another datum.
MapBuildSummary buildMap(const MapBuildJob& job, const AllSettings& settings,
                         const ScanProgress& progress = {});

}  // namespace polemcl::apps
