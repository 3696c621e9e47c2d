#pragma once
/// \file Inflate.h
/// \brief Decompression of data whose size a file only claims.

#include <cstdint>
#include <string>
#include <string_view>

namespace polemcl::io {

enum class Deflated { zlib, bare };  ///< with zlib's header and checksum; as zip archives have it

/// \brief Decompresses. Memory is taken as the data comes: a false claim costs at most twice what
/// the data really holds.
/// \param size As the file claims. \param where Start of the message.
/// \throws Error when the data is damaged, holds more or less than that, or cannot hold it (see
///         greatestDeflateRatio).
std::string inflated(std::string_view data, std::uint64_t size, Deflated kind,
                     const std::string& where);

}  // namespace polemcl::io
