#pragma once
/// \file NcltScans.h
/// \brief The LiDAR files of NCLT: scans of velodyne_sync, packets of velodyne_hits.bin.
///
/// A point is eight bytes, little-endian: uint16 x y z (metres = value · 0.005 − 100), uint8
/// intensity, uint8 laser, as in read_vel_sync.py and read_vel_hits.py of the dataset.

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <polemcl/io/data/Cloud.h>
#include "io/file/TextFile.h"

namespace polemcl::io {

/// \brief Reads one scan of velodyne_sync, in the body frame: x forward, y right, z down.
/// Intensity 0 … 255. Points at the origin are dropped and counted.
/// \throws Error when the file cannot be read or is truncated.
Cloud readNcltSync(const std::filesystem::path& file);

/// \brief Pose of the HDL-32E in the body frame (both z down, as mounted): 0.957 m above the
/// origin, rotated by −90.7°. From the calibration of the dataset.
Eigen::Isometry3d ncltBodyLidar();

/// \brief One complete revolution of the LiDAR in velodyne_hits.bin.
struct NcltTurn {
  std::uint64_t offset = 0, bytes = 0;    ///< position of its packets in the file
  double begin = 0, middle = 0, end = 0;  ///< times of first packet, middle and last packet, s
};

/// \brief Finds the revolutions in velodyne_hits.bin. A packet holds: four times uint16 44444,
/// uint32 number of points, uint64 time (µs), four bytes of padding, points in the LiDAR frame. A
/// revolution ends with the packet that completes a full circle of azimuth. The file is read once,
/// packet by packet.
/// \param notes Gets a line with the number of incomplete revolutions: the last one, and those with
///        a gap.
/// \throws Error with the byte offset: not a packet, truncated packet; no complete revolution in
///         the file.
std::vector<NcltTurn> findNcltTurns(const std::filesystem::path& file,
                                    std::vector<std::string>& notes,
                                    const ReadProgress& progress = {});

/// \brief Motion of the body during one revolution of the LiDAR.
struct TurnMotion {
  Eigen::Isometry3d T_middle_begin = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_middle_end = Eigen::Isometry3d::Identity();
};

/// \brief The points of a revolution, in the body frame (z down) at its middle.
/// \param motion Moves each packet to the middle, at constant speed before and after it. Without it
///        the points are not motion compensated.
/// \throws Error when the file cannot be read or has changed.
Cloud readNcltTurn(const std::filesystem::path& file, const NcltTurn& turn,
                   const std::optional<TurnMotion>& motion);

}  // namespace polemcl::io
