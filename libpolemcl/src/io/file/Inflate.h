#pragma once
/// \file Inflate.h
/// \brief Decompression of data whose size is only claimed by a file.

#include <cstdint>
#include <string>
#include <string_view>

namespace polemcl::io {

/// \brief Decompresses what zlib compressed. Memory grows with the data: a false size costs at most
/// twice the memory of the actual content. \param size Uncompressed size that the file claims.
/// \param where Prefix of error messages. \throws Error when the data are damaged, hold more or
/// less than `size`, or cannot hold it (see
///         mostInflated()).
std::string inflated(std::string_view data, std::uint64_t size, const std::string& where);

}  // namespace polemcl::io
