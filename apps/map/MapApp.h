#pragma once
/// \file MapApp.h
/// \brief `pole-map`: scans or poles at true poses -> a pole map.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/Settings.h"
#include "core/mapping/MapAccumulator.h"
#include "io/map/Datum.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl::apps {

/// \brief Files of `pole-map`.
struct MapOptions {
  std::vector<std::filesystem::path> inputs;   ///< rawlogs of scans or poles, at least one
  std::vector<std::filesystem::path> truths;   ///< TUM, robot poses, one file per input
  std::filesystem::path output;                ///< `.polemap`
  std::optional<std::filesystem::path> scene;  ///< `.3Dscene` of map and path, when given
  std::optional<std::filesystem::path> csv;    ///< poles as a table, when given
  bool allowTruncated = false;                 ///< use the readable part of damaged rawlogs
  std::vector<std::string> dates = {};         ///< YYYY-MM-DD, one per input, or none
  /// `.polemap` that keeps its scans: the inputs are sessions after those it was made from.
  std::optional<std::filesystem::path> add = {};
  bool keepScans = false;               ///< in the map, for `add`; always when `add` is given
  std::optional<io::Datum> datum = {};  ///< of the truths: goes into the map's info
  /// \throws Error naming the option.
  void validate() const;
};

/// \brief What mapping did, summed over the inputs.
struct MapSummary {
  std::size_t scans = 0;          ///< used
  std::size_t visited = 0;        ///< scans at true poses, used or not
  std::size_t emptyScans = 0;     ///< without a valid point: not used
  std::size_t unmatched = 0;      ///< scans at whose time the truth says nothing: not used
  std::size_t invalidPoints = 0;  ///< dropped
  std::size_t truncated = 0;      ///< inputs that ended too early, and that was allowed
  PoleMapResult map;
  /// \brief How much of a session is in the map.
  struct Session {
    std::string name;                 ///< of the rawlog
    std::size_t scans = 0, used = 0;  ///< at true poses; of these
    double share = 0;                 ///< used / scans, `f_map`
  };
  std::vector<Session> sessions;  ///< in their order, those of `add` first
};

/// \brief Builds the map, with a history of each pole for later upkeep, and writes what was asked
/// for. The inputs are sessions, in their order: see MapAccumulator for which scans are used. The
/// map's info holds `f_map.NAME` for each, NAME the rawlog's without its ending. The truth is
/// interpolated at the time of each scan, not across gaps of more than 2 s.
/// \param progress Of the current input; may be empty.
/// \throws Error as readPoleSequence() and readTum(); when the truth covers less than half of the
///         scans of an input; when no scan is usable; when no pole was found (names the section
///         length, the scan spacing and the counts); when `add` keeps no scans, or ones chosen by
///         another `unvisited_m`, or has another datum.
MapSummary buildMap(const MapOptions& options, const Settings& settings,
                    const ScanProgress& progress = {});

/// \brief The program, with `--update` (MapUpdateApp.h) and `--diff` (MapDiffApp.h). \return An
/// ExitCode.
int mapMain(int argc, const char* const* argv);

}  // namespace polemcl::apps
