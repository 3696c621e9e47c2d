#pragma once
/// \file BagFiles.h
/// \brief Which files a ROS 2 bag consists of.

#include <filesystem>
#include <vector>

namespace polemcl::io {

/// \brief What a bag consists of.
struct BagFiles {
  std::vector<std::filesystem::path> files;  ///< `.db3` or `.mcap`, in the order of recording
  bool compressedMessages = false;           ///< each message by itself, with Zstandard
};

/// \brief Finds the files of a bag.
///
/// From `metadata.yaml` come the storage, the compression and the list of files, in the layout in
/// which rosbag2 writes them. Where a file is compressed as a whole (`.mcap.zstd`, `.db3.zst`), the
/// unpacked one beside it takes its place.
/// \param bag Folder, or one `.db3` or `.mcap` file.
/// \throws Error with the file: there is no such file, a file that is compressed as a whole
///         (with the command that unpacks it), another storage.
BagFiles bagFiles(const std::filesystem::path& bag);

}  // namespace polemcl::io
