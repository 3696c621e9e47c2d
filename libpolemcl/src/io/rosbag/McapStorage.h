#pragma once
/// \file McapStorage.h
/// \brief A file of a ROS 2 bag in MCAP.

#include <filesystem>
#include <memory>

#include "io/rosbag/BagStorage.h"

namespace polemcl::io {

/// \brief Limit of a decompressed chunk or message, bytes.
constexpr std::uint64_t kMostInBag = 1 << 30;

/// \brief Opens an `.mcap` file; it is only read.
///
/// Chunks stay compressed until one of their messages is read, unless they have no index. Where
/// the end of the file is missing, what is whole before it is there, with a note.
/// \throws Error when it is damaged.
std::unique_ptr<BagStorage> openMcapStorage(const std::filesystem::path& file);

}  // namespace polemcl::io
