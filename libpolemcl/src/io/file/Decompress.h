#pragma once
/// \file Decompress.h
/// \brief Decompression with Zstandard, LZ4 and zlib, up to a limit.

#include <cstdint>
#include <string>
#include <string_view>

namespace polemcl::io {

/// \brief Decompresses frames of Zstandard. Memory grows with the content.
/// \param most Limit of the content in bytes. \param where Prefix of errors.
/// \throws Error when the data are damaged or cut short, or hold more than `most`.
std::string decompressedZstd(std::string_view data, std::uint64_t most, const std::string& where);

/// \brief The same for frames of LZ4.
std::string decompressedLz4(std::string_view data, std::uint64_t most, const std::string& where);

/// \brief Decompresses one stream of zlib whose size a file claims. \param size Claimed size,
/// bytes. \throws Error when the data are damaged, hold more or less than `size`, or cannot hold it
///         (mostInflated()).
std::string inflated(std::string_view data, std::uint64_t size, const std::string& where);

}  // namespace polemcl::io
