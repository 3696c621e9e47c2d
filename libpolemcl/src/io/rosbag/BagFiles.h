#pragma once
/// \file BagFiles.h
/// \brief Which files a ROS 2 bag consists of.

#include <filesystem>
#include <vector>

namespace polemcl::io {

/// \brief The `.db3` files of a bag, in the order of recording.
///
/// From `metadata.yaml` come the storage, the compression and the list of files, in the layout in
/// which rosbag2 writes them.
/// \param bag Folder, or one `.db3` file.
/// \throws Error with the file: there is no such file, a compressed bag, another storage (MCAP).
std::vector<std::filesystem::path> bagFiles(const std::filesystem::path& bag);

}  // namespace polemcl::io
