#pragma once
/// \file Decompress.h
/// \brief Decompression with Zstandard and LZ4, up to a limit.

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

}  // namespace polemcl::io
