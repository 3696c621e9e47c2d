#pragma once
/// \file BagStorage.h
/// \brief What a bag of ROS 2 asks of one of its files, whatever its format.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/file/ReadLimits.h"

namespace polemcl::io {

/// \brief A topic of one file.
struct StoredTopic {
  std::int64_t id = 0;       ///< positive
  std::string name;          ///< "/points"
  std::string type;          ///< "sensor_msgs/msg/PointCloud2"
  std::string format;        ///< of its messages: "cdr" or empty; others are not those of ROS 2
  std::size_t messages = 0;  ///< may be none
};

/// \brief One file of a bag, open for reading.
class BagStorage {
 public:
  BagStorage() = default;
  BagStorage(const BagStorage&) = delete;
  BagStorage& operator=(const BagStorage&) = delete;
  virtual ~BagStorage() = default;
  virtual std::vector<StoredTopic> topics() const = 0;
  /// \brief Ids of the messages of a topic in the order in which they were recorded.
  virtual std::vector<std::int64_t> messages(std::int64_t topic) const = 0;
  /// \brief The bytes of a message, at most the first `most`. \param where Prefix of errors.
  /// \throws Error when they cannot be read.
  virtual std::string read(std::int64_t message, std::size_t most,
                           const std::string& where) const = 0;
  /// \brief What its user should know: a recording that was cut short. Empty if there is nothing.
  virtual std::string note() const { return {}; }
};

/// \brief Opens a `.db3` file; it is only read. \throws Error when it is no bag in SQLite.
std::unique_ptr<BagStorage> openSqliteStorage(const std::filesystem::path& file);

/// \brief Opens an `.mcap` file; it is only read.
///
/// Chunks stay compressed until one of their messages is read, unless they have no index. Where
/// the end of the file is missing, what is whole before it is there, with a note.
/// \throws Error when it is damaged.
std::unique_ptr<BagStorage> openMcapStorage(const std::filesystem::path& file);

/// \brief Refuses a file with more than 10,000 topics, which takes long to be listed.
/// \param where Prefix of the error.
void requireFewTopics(std::size_t topics, const std::string& where);

/// \brief Limit of a chunk or message after decompression. \param compressed Its bytes in the bag.
constexpr std::uint64_t mostInBag(std::uint64_t compressed) {
  return std::min(std::uint64_t{1} << 30, mostInflated(compressed));
}

}  // namespace polemcl::io
