#pragma once
/// \file MapScans.h
/// \brief What a `.polemap` keeps of the scans it was made from, so that sessions can be added
/// later.
///
/// Content of the chunk `SCAN`: uint64 size, then so many bytes deflated (zlib): float64 unvisited
/// (m), uint32 sessions; of each: text name (uint32 length, bytes), uint64 scans; of each: float64
/// time, x, y, yaw, uint32 used. Of those used (1): float64 x, y, yaw of the sensor in the robot
/// frame; uint32 detections, of each: float64 x, y, radius, bottom, top, confidence, covariance xx,
/// xy, yx, yy, uint32 points; uint32 free ranges, float32 each.

#include <string>
#include <string_view>

#include "core/mapping/MapAccumulator.h"

namespace polemcl::io {

/// \brief The content of the chunk; same sessions, same bytes.
std::string packMapScans(const AddedSessions& added);

/// \brief The other way round, to the last bit. \param where Start of the message of errors.
/// \throws Error when it is damaged.
AddedSessions unpackMapScans(std::string_view content, const std::string& where);

}  // namespace polemcl::io
