#pragma once
/// \file MapUpdateApp.h
/// \brief `pole-map update`: a map and sessions driven through it -> the map of today.

#include <filesystem>
#include <string>
#include <vector>

#include "map/MappingSession.h"

namespace polemcl::apps {

/// \brief Files of `pole-map update`.
struct MapUpdateJob : MappingJob {
  std::filesystem::path map;  ///< `.polemap` to begin with; `output` may name it again
};

/// \brief What updating did.
struct MapUpdateSummary {
  std::vector<MapUpdateCounts> sessions;  ///< one per input
  std::size_t before = 0;                 ///< poles on the map to begin with
  std::size_t poles = 0;                  ///< now
  SkippedScans skipped;
  std::vector<std::string> doubts;  ///< turnDoubts() of the sessions
};

/// \brief Updates the map by one session after the other, in the order given, and writes what was
/// asked for. Candidates are kept in the file, beside the map. Scans kept for `build --add` are
/// not: the updated map no longer follows from them.
/// \param progress Progress of the current input; may be empty.
/// \throws Error as loadMappingSession(), updateMap(), readPoleMap(); when the datum differs from
///         the map's; when a session has no usable scan; when fewer than a fifth of at least ten
///         map poles in free view were found: a session of another place, or of another datum, must
///         not spoil a map; when no scan is left because the localizer was not `ok`.
MapUpdateSummary updateMapFile(const MapUpdateJob& job, const AllSettings& settings,
                               const ScanProgress& progress = {});

/// \brief What the program prints.
std::string summaryText(const MapUpdateSummary& summary, const MapUpdateJob& job);

/// \brief turnDoubts(), and a line for each session of which more than 5 % of the poles in view
/// "moved". Poles seldom do: rather the poses are wrong.
std::vector<std::string> warningsOf(const MapUpdateSummary& summary, const MapUpdateJob& job);

}  // namespace polemcl::apps
