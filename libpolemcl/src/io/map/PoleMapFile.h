#pragma once
/// \file PoleMapFile.h
/// \brief The `.polemap` file: poles with all they carry, checksummed.
///
/// Little-endian. Header, 24 bytes: magic `89 'P' 'M' 'A' 'P' 0D 0A 1A`, uint32 version (1), uint64
/// size of the payload, uint32 CRC-32 of the payload; nothing follows the payload. Payload: chunks
/// of a four-letter tag, uint64 size, content. Readers skip chunks they do not know.
/// - `INFO`: uint32 count, then key and value of each, as uint32 length and bytes.
/// - `POLE`: uint32 bytes a record, uint64 count, records: float64 x, y, radius, bottom, top,
///   confidence, covariance xx, xy, yy; uint32 count. Then, where histories are known: float64
///   existence, first seen, last seen (s since 1970, 0 = not known); uint32 seen, missed. Later
///   writers append fields to the record; readers use the fields they know and skip the rest.
/// - `CAND`, where there are any: as `POLE`, always with histories: poles that are not on the map.
/// - `SCAN`, where that was asked for: the scans the map was made from, see MapScans.h.
///
/// The version grows only when that is not enough: programs that know no histories read these maps,
/// and leave out the candidates as they should.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/common/Types.h"
#include "core/mapping/MapAccumulator.h"
#include "core/mapping/MapUpdater.h"

namespace polemcl::io {

struct PoleMapData {
  std::vector<MapPole> poles;
  std::map<std::string, std::string> info;  ///< how it was made: free keys and values, UTF-8
  std::vector<PoleHistory> histories = {};  ///< of each of `poles`; empty: not known
  /// Not on the map: new ones that have not earned their place, faded ones. `present` is false.
  std::vector<LandmarkRecord> candidates = {};
};

/// \brief The poles of the file with their histories, for updateMap(); as landmarksFrom() where the
/// file has none.
LandmarkMap landmarkMap(const PoleMapData& data);
/// \brief The other way round.
PoleMapData mapData(const LandmarkMap& map, std::map<std::string, std::string> info);

/// \brief Writes atomically; same data, same bytes.
/// \param scans If given: kept in the file, so that sessions can be added.
/// \throws Error when it cannot be written, or naming the pole whose values are not finite, whose
///         radius is negative, confidence outside [0, 1], or covariance not positive definite; or
///         whose history has an existence outside [0, 1] or a time that is negative or not finite;
///         or when there are histories, but not one for each pole.
void writePoleMap(const std::filesystem::path& file, const PoleMapData& data,
                  const AddedSessions* scans = nullptr);

/// \brief The scans that the file keeps; none when it keeps none. \throws Error as readPoleMap().
std::optional<AddedSessions> readMapScans(const std::filesystem::path& file);

/// \throws Error when it cannot be read, is no pole map, is cut short or damaged, was written by a
///         newer version, or holds poles that writePoleMap() would refuse.
PoleMapData readPoleMap(const std::filesystem::path& file);

}  // namespace polemcl::io
