#pragma once
/// \file SqliteStorage.h
/// \brief A file of a ROS 2 bag in SQLite (`.db3`).

#include <filesystem>
#include <memory>

#include "io/rosbag/BagStorage.h"

namespace polemcl::io {

/// \brief Opens a `.db3` file; it is only read. \throws Error when it is no bag in SQLite.
std::unique_ptr<BagStorage> openSqliteStorage(const std::filesystem::path& file);

}  // namespace polemcl::io
