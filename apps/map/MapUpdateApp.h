#pragma once
/// \file MapUpdateApp.h
/// \brief `pole-map --update`: a map and sessions driven through it -> the map of today.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/Settings.h"
#include "core/mapping/MapUpdater.h"
#include "io/map/Datum.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl::apps {

/// \brief Files of `pole-map --update`.
struct MapUpdateJob {
  std::filesystem::path map;                   ///< `.polemap` to begin with
  std::vector<std::filesystem::path> inputs;   ///< rawlogs of scans or poles, one a session
  std::vector<std::filesystem::path> truths;   ///< TUM, robot poses, one file per input
  std::vector<std::string> dates;              ///< YYYY-MM-DD, one per input, or none
  std::filesystem::path output;                ///< `.polemap`, may be `map`
  std::optional<std::filesystem::path> scene;  ///< `.3Dscene` of map and paths, when given
  std::optional<std::filesystem::path> csv;    ///< poles as a table, when given
  bool allowTruncated = false;                 ///< use the readable part of damaged rawlogs
  std::optional<io::Datum> datum = {};         ///< of the truths; must be that of the map
  /// \throws Error naming the option.
  void validate() const;
};

/// \brief What upkeep did.
struct MapUpdateSummary {
  std::vector<MapUpdateCounts> sessions;  ///< one per input
  std::size_t before = 0;                 ///< poles on the map to begin with
  std::size_t poles = 0;                  ///< now
  std::size_t emptyScans = 0, unmatched = 0, invalidPoints = 0, truncated = 0;
};

/// \brief Updates the map by one session after the other, in the order given, and writes what was
/// asked for. Candidates are kept in the file, beside the map; scans kept for `--add` are not: the
/// map is no longer what they say.
/// \param progress Of the current input; may be empty.
/// \throws Error as loadMappingSession(), updateMap(), readPoleMap(); when the datum is another one
/// than
///         the map's; when a session has no usable scan; when fewer than a fifth of at least ten
///         map poles in free view were found: a session of another place, or of another datum, must
///         not spoil a map.
MapUpdateSummary updateMapFile(const MapUpdateJob& options, const Settings& settings,
                               const ScanProgress& progress = {});

/// \brief What the program tells of it.
void print(const MapUpdateSummary& summary, const MapUpdateJob& options);

}  // namespace polemcl::apps
