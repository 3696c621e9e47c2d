#pragma once
/// \file MapBuildReport.h
/// \brief What `pole-map build` says of a map: in its info, as warnings, and on the screen.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/map/Datum.h"
#include "map/MapBuildApp.h"

namespace polemcl::apps {

/// \brief The info of the map.
/// \param before The info of the map that is added to; used if the job adds.
std::map<std::string, std::string> mapFacts(const AllSettings& settings,
                                            const MapBuildSummary& summary, const MapBuildJob& job,
                                            const std::optional<io::Datum>& datum,
                                            const std::map<std::string, std::string>& before);

/// \brief Why no pole was found: section length, distance between scans, counts.
std::string noPolesText(const MapBuildSummary& summary);

/// \brief Signs that poses or timing are wrong: poles that contradict them, many twins. Also in the
/// map's info, key `warnings`.
std::vector<std::string> warningsOf(const MapBuildSummary& summary, const MapBuildJob& job);

/// \brief What the program prints.
std::string summaryText(const MapBuildSummary& summary, const MapBuildJob& job);

}  // namespace polemcl::apps
