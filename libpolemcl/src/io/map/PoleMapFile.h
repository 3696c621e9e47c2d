#pragma once
/// \file PoleMapFile.h
/// \brief The `.polemap` file: poles with all their attributes, checksummed.
///
/// Little-endian. Header, 24 bytes: magic `89 'P' 'M' 'A' 'P' 0D 0A 1A`, uint32 version (1), uint64
/// size of the payload, uint32 CRC-32 of the payload. Nothing follows the payload. The payload
/// consists of chunks: four-letter tag, uint64 size, content. Readers skip unknown chunks.
/// - `INFO`: uint32 count, then key and value of each, as uint32 length and bytes.
/// - `POLE`: uint32 bytes per record, uint64 count, records: float64 x, y, radius, bottom, top,
///   confidence, covariance xx, xy, yy; uint32 count. If histories are known: float64 existence,
///   first seen, last seen (s since 1970, 0 = not known); uint32 seen, missed. Later versions may
///   append fields to the record; readers use the fields they know and skip the rest.
/// - `CAND` (optional): as `POLE`, always with histories: poles that are not on the map.
/// - `SCAN` (optional): the scans from which the map was made, so that sessions can be added later:
///   uint64 size, followed by deflated data (zlib) with that uncompressed size:
///   - float64 unvisited (m), uint32 number of sessions
///   - per session: text name (uint32 length, bytes), uint64 number of scans
///   - per scan: float64 time, x, y, yaw, uint32 used
///   - per scan with used = 1: float64 x, y, yaw of the sensor in the robot frame; uint32 number of
///     detections; uint32 number of visibility ranges after the detections, each float32
///   - per detection: float64 x, y, radius, bottom, top, confidence, covariance xx, xy, yx, yy,
///     uint32 points
///   - not by 1.0.0, per session: uint64 number of covariances (0, or that of its scans), each
///     float64 xx, xy, xyaw, yy, yyaw, yawyaw
///
/// The version changes only when this scheme is not enough. Programs that do not know histories can
/// read these maps, and they correctly ignore the candidates.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>
#include "core/mapping/MapAccumulator.h"

namespace polemcl::io {

struct PoleMapData {
  std::vector<MapPole> poles;
  std::map<std::string, std::string> info;  ///< origin of the map: free keys and values, UTF-8
  std::vector<PoleHistory> histories = {};  ///< one per pole in `poles`; empty: not known
  /// Poles that are not on the map: new ones that are not confirmed yet, and faded ones. `present`
  /// is false.
  std::vector<LandmarkRecord> candidates = {};
};

/// \brief The poles of the file with their histories, for updateMap(). Without histories in the
/// file, the same as landmarksFrom().
POLEMCL_EXPORT LandmarkMap landmarkMap(const PoleMapData& data);
/// \brief Inverse of landmarkMap().
POLEMCL_EXPORT PoleMapData mapData(const LandmarkMap& map, std::map<std::string, std::string> info);

/// \throws Error, which begins with `where`, when the data are invalid. For a pole: values not
///         finite, negative radius, confidence outside [0, 1], covariance not positive
///         semidefinite. For a history: existence outside [0, 1], time negative or not finite. Also
///         when the number of histories is neither 0 nor the number of poles.
POLEMCL_EXPORT void requireSound(const PoleMapData& data, const std::string& where);

/// \brief Writes atomically; equal data give equal bytes.
/// \param scans Optional: stored in the file, so that sessions can be added later.
/// \throws Error when the file cannot be written, or as requireSound().
POLEMCL_EXPORT void writePoleMap(const std::filesystem::path& file, const PoleMapData& data,
                                 const AddedSessions* scans = nullptr);

/// \param scans Gets the scans stored in the file, if it has some; of the same bytes, because
/// another program may replace the file at any moment.
/// \throws Error when the file cannot be read, is not a pole map, is truncated or damaged, was
///         written by a newer version, or holds poles that writePoleMap() rejects.
POLEMCL_EXPORT PoleMapData readPoleMap(const std::filesystem::path& file,
                                       std::optional<AddedSessions>* scans = nullptr);

/// \brief Packs the content of the chunk; equal sessions give equal bytes.
std::string packMapScans(const AddedSessions& added);

/// \brief Inverse of packMapScans(), exact to the last bit. \param where Prefix of error messages.
/// \throws Error when the content is damaged.
AddedSessions unpackMapScans(std::string_view content, const std::string& where);

}  // namespace polemcl::io
