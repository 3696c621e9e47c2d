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

#include "io/data/Cloud.h"
#include "io/file/ReadProgress.h"

namespace polemcl::io {

/// \brief One scan of velodyne_sync, in the body frame: x ahead, y right, z down.
/// Intensity 0 … 255. Points at the origin are dropped and counted.
/// \throws Error when it cannot be read, or is cut short.
Cloud readNcltSync(const std::filesystem::path& file);

/// \brief The HDL-32E (its own frame, z down as mounted) in the body frame (z down): 0.957 m above
/// its origin, turned by −90.7°. From the calibration that comes with the dataset.
Eigen::Isometry3d ncltBodyLidar();

/// \brief A whole turn of the LiDAR in velodyne_hits.bin.
struct NcltTurn {
  std::uint64_t offset = 0, bytes = 0;    ///< its packets in the file
  double begin = 0, middle = 0, end = 0;  ///< times of the first packet, half way, the last one, s
};

/// \brief Finds the turns in velodyne_hits.bin. A packet is: uint16 44444 four times, uint32 number
/// of points, uint64 time (µs), four bytes of padding, points in the LiDAR's frame. A turn ends
/// with the packet in which the beams have come round; the file is read once, packet by packet.
/// \param notes Gets a line when turns were left out: the last one, and those with a gap.
/// \throws Error with the byte where it happened: no packet, a packet cut short; no whole turn.
std::vector<NcltTurn> findNcltTurns(const std::filesystem::path& file,
                                    std::vector<std::string>& notes,
                                    const ReadProgress& progress = {});

/// \brief How the body moved while the LiDAR turned once.
struct TurnMotion {
  Eigen::Isometry3d T_middle_begin = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_middle_end = Eigen::Isometry3d::Identity();
};

/// \brief The points of a turn, in the body frame (z down) at its middle.
/// \param motion Moves each packet to the middle, at constant speed before and after it; without,
///        points stay where the moving LiDAR saw them.
/// \throws Error when the file cannot be read or has changed.
Cloud readNcltTurn(const std::filesystem::path& file, const NcltTurn& turn,
                   const std::optional<TurnMotion>& motion);

}  // namespace polemcl::io
