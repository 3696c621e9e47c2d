#pragma once
/// \file ReadLimits.h
/// \brief What files may claim. A length or count that a file claims is refused with an Error,
/// before memory is taken for it, when the bytes that are left cannot hold it or when it is above a
/// limit here. The first alone bounds `.polemap`, `.npy`, `.bin` and binary PCD files.

#include <cstddef>
#include <cstdint>

namespace polemcl::io {

/// Text of a table, plain or gzip, bytes when unpacked: a small gzip file can hold very much.
inline constexpr std::size_t mostTextBytes = std::size_t{128} << 20;
/// Deflated data (`.npz`, scans of a `.polemap`) is at most so many times smaller than its content.
inline constexpr std::uint64_t greatestDeflateRatio = 1032;
/// LZF data (compressed PCD) as well: 264 bytes become three.
inline constexpr std::uint64_t greatestLzfRatio = 88;
/// Points of one packet of NCLT's velodyne_hits.bin; an HDL-32E sends 384.
inline constexpr std::uint32_t mostPacketPoints = 100'000;

/// Limits of one CObservationPoles in an archive of MRPT: poles, free ranges, bytes of the label,
/// each.
inline constexpr std::uint32_t mostOfAScan = 1 << 16;
/// Limits of a CPoleMap in an archive of MRPT: poles, facts of `info`, bytes of a fact's name or
/// value.
inline constexpr std::uint32_t mostMapPoles = 10'000'000, mostMapFacts = 1 << 16,
                               longestMapFact = 1 << 24;

}  // namespace polemcl::io
