#pragma once
/// \file ReadLimits.h
/// \brief Limits for claims of files. A length or count in a file is rejected with an Error before
/// memory is allocated for it, in two cases: the remaining bytes cannot hold it, or it exceeds a
/// limit below. The first rule alone bounds `.polemap`, `.npy`, `.bin` and binary PCD files.

#include <cstddef>
#include <cstdint>

namespace polemcl::io {

/// Largest text of a table in gzip, bytes after decompression: a small file can hold very much.
inline constexpr std::size_t kMostTextBytes = std::size_t{128} << 20;
/// Most bytes that are read from a pipe into memory: nobody knows its size.
inline constexpr std::size_t kMostPipedBytes = std::size_t{256} << 20;
/// Memory of a line or field of a table that is kept, beside its text.
inline constexpr std::uint64_t kKeptTextBytes = 32;
/// Most bytes that compressed tables, maps and scans may hold, by the bytes that they take. Numbers
/// and text shrink to a third or a tenth of their size; the first part allows small empty ones.
constexpr std::uint64_t mostInflated(std::uint64_t compressed) {
  return (std::uint64_t{16} << 20) + 50 * compressed;
}
/// Largest compression ratio of deflated data (rawlogs).
inline constexpr std::uint64_t kGreatestDeflateRatio = 1032;
/// Largest compression ratio of LZF data (compressed PCD): three bytes hold up to 264.
inline constexpr std::uint64_t kGreatestLzfRatio = 88;
/// Most points in one packet of NCLT's velodyne_hits.bin; an HDL-32E sends 384.
inline constexpr std::uint32_t kMostPacketPoints = 100'000;

/// Limit for each list of one CObservationPoles in an MRPT archive: poles, visibility ranges, bytes
/// of the label.
inline constexpr std::uint32_t kMostOfAScan = 1 << 16;
/// Limits of a CPoleMap in an MRPT archive: poles, entries of `info`, bytes of the key or value of
/// an entry.
inline constexpr std::uint32_t kMostMapPoles = 10'000'000, kMostMapFacts = 1 << 16,
                               kLongestMapFact = 1 << 24;

}  // namespace polemcl::io
