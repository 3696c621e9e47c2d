#pragma once
/// \file Bag.h
/// \brief ROS 2 bags in SQLite (`.db3`) and MCAP (`.mcap`) files, read without ROS.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "io/rosbag/BagStorage.h"

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

/// \brief A topic of a bag.
struct BagTopic {
  std::string name;          ///< "/points"
  std::string type;          ///< "sensor_msgs/msg/PointCloud2"
  std::size_t messages = 0;  ///< in all files
};

/// \brief A message that stays in the bag.
struct BagMessage {
  std::size_t file = 0;   ///< index of the file
  std::size_t topic = 0;  ///< index in Bag::topics()
  std::int64_t id = 0;    ///< as the storage of that file counts
};

/// \brief A bag that is open for reading.
///
/// A folder has one or several files, read in the order of its `metadata.yaml` (without it, in the
/// order of their numbers). One file alone is a bag too. The files are only read.
class Bag {
 public:
  /// \param bag Folder, or one `.db3` or `.mcap` file.
  /// \throws Error with the file: there is no file, not a bag in SQLite or MCAP, files that are
  ///         compressed as a whole, a topic that has two types, no topic in CDR but others.
  explicit Bag(const std::filesystem::path& bag);

  const std::filesystem::path& path() const { return m_path; }
  /// \brief Sorted by name.
  const std::vector<BagTopic>& topics() const { return m_topics; }
  /// \brief The messages of a topic in the order in which they were recorded.
  /// \throws Error when a file lists another number of them than it has.
  /// \param topic Index in topics().
  std::vector<BagMessage> messages(std::size_t topic) const;
  /// \brief A message by its file and id. \throws Error when the bag has no such file.
  BagMessage message(std::size_t topic, const std::filesystem::path& file, std::int64_t id) const;
  /// \brief The bytes of a message, at most the first `most`. \throws Error when they cannot be
  ///        read.
  std::string read(const BagMessage& message, std::size_t most = SIZE_MAX) const;
  /// \brief Topics in other formats than CDR, which are left out: "/state (json)". Sorted.
  const std::set<std::string>& leftOut() const { return m_leftOut; }
  /// \brief What is to know of the files: a recording that was cut short, topics left out.
  std::vector<std::string> notes() const;
  const std::filesystem::path& file(const BagMessage& message) const;
  /// \brief "FILE: /points, message 17: ", the prefix of an error.
  std::string place(const BagMessage& message) const;

 private:
  struct File {
    std::filesystem::path path;
    std::unique_ptr<BagStorage> storage;
    std::vector<std::int64_t> topicIds;  ///< for each topic of the bag; 0: not in this file
  };
  void open(const std::filesystem::path& file);
  void addTopic(File& file, const StoredTopic& topic);
  void sortTopics();

  std::filesystem::path m_path;
  bool m_compressed = false;  ///< each message by itself, with Zstandard
  std::vector<File> m_files;
  std::vector<BagTopic> m_topics;
  std::set<std::string> m_leftOut;
};

}  // namespace polemcl::io
