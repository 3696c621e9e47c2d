#pragma once
/// \file MapScans.h
/// \brief Storage of the mapping scans in a `.polemap`, so that sessions can be added later.
///
/// Content of the chunk `SCAN`: uint64 size, followed by deflated data (zlib) with that
/// uncompressed size:
/// - float64 unvisited (m), uint32 number of sessions
/// - per session: text name (uint32 length, bytes), uint64 number of scans
/// - per scan: float64 time, x, y, yaw, uint32 used
/// - per scan with used = 1: float64 x, y, yaw of the sensor in the robot frame; uint32 number of
///   detections; uint32 number of visibility ranges after the detections, each float32
/// - per detection: float64 x, y, radius, bottom, top, confidence, covariance xx, xy, yx, yy,
///   uint32 points
/// - not by 1.0.0, per session: uint64 number of covariances (0, or that of its scans), each
///   float64 xx, xy, xyaw, yy, yyaw, yawyaw

#include <string>
#include <string_view>

#include "core/mapping/MapAccumulator.h"

namespace polemcl::io {

/// \brief Packs the content of the chunk; equal sessions give equal bytes.
std::string packMapScans(const AddedSessions& added);

/// \brief Inverse of packMapScans(), exact to the last bit. \param where Prefix of error messages.
/// \throws Error when the content is damaged.
AddedSessions unpackMapScans(std::string_view content, const std::string& where);

}  // namespace polemcl::io
