#pragma once
/// \file MapApp.h
/// \brief `pole-map`: scans or poles at true poses -> a pole map.

#include <polemcl/apps/Settings.h>
#include <polemcl/core/PoleMapBuilder.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

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
  /// \throws Error naming the option.
  void validate() const;
};

/// \brief What mapping did, summed over the inputs.
struct MapSummary {
  std::size_t scans = 0;          ///< used
  std::size_t emptyScans = 0;     ///< without a valid point: not used
  std::size_t unmatched = 0;      ///< scans at whose time the truth says nothing: not used
  std::size_t invalidPoints = 0;  ///< dropped
  std::size_t truncated = 0;      ///< inputs that ended too early, and that was allowed
  PoleMapResult map;
};

/// \brief Builds the map, with a history of each pole for later upkeep, and writes what was asked
/// for. The truth is interpolated at the time of each scan, not across gaps of more than 2 s.
/// \param progress Called with the number of scans of the current input; may be empty.
/// \throws Error as readPoleSequence() and readTum(); when the truth covers less than half of the
///         scans of an input; when no scan is usable; when no pole was found (names the section
///         length, the scan spacing and the counts).
MapSummary buildMap(const MapOptions& options, const Settings& settings,
                    const std::function<void(std::size_t)>& progress = {});

/// \brief The program, with `--update` (MapUpdateApp.h) and `--diff` (MapDiffApp.h). \return An
/// ExitCode.
int mapMain(int argc, const char* const* argv);

}  // namespace polemcl::apps
