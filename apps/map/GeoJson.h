#pragma once
/// \file GeoJson.h
/// \brief Pole maps for geographic programs: GeoJSON (RFC 7946) points on WGS 84.

#include <filesystem>
#include <optional>
#include <string>

#include "io/map/Datum.h"
#include "io/map/PoleMapFile.h"

namespace polemcl::apps {

/// \brief Writes the poles on the map (no candidates) as a FeatureCollection of points, atomically.
///
/// Properties: `radius`, `bottom`, `top` (m), `confidence`, `count`, `covariance` (xx, xy, yy in
/// the map's axes, m²); with histories `existence`, `seen`, `missed`, and where known `first_seen`,
/// `last_seen` (days), `first_seen_s`, `last_seen_s` (s since 1970). The collection's foreign
/// member `polemcl` holds the map's info, the datum among it. Coordinates have ten decimals, 0.01
/// mm. \throws Error when the info has no datum, and when it cannot be written.
void writeGeoJson(const std::filesystem::path& file, const io::PoleMapData& map);

/// \brief Reads the points of a FeatureCollection. What a point does not tell gets defaults: radius
/// 0.1, bottom 0 and top 0 (not known), confidence 1, count 1, covariance 0.01 m² each way. If one
/// of them tells an existence, all have histories; one that does not tell it (a pole added by hand)
/// has that of landmarksFrom(). A MultiPoint of one point is a point. Other geometries are left
/// out.
/// \param datum Where the file has none; must be the same where it has one.
/// \param left If given: how many features were no points.
/// \throws Error naming the feature: not GeoJSON, no point in it, numbers that are none or out of
///         range; no datum; another one than the file's.
io::PoleMapData readGeoJson(const std::filesystem::path& file,
                            const std::optional<io::Datum>& datum = std::nullopt,
                            std::size_t* left = nullptr);

/// \brief The end of a message that there is no point; empty if there are no others either.
std::string othersText(std::size_t others);

}  // namespace polemcl::apps
