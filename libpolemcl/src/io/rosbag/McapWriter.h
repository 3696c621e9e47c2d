#pragma once
/// \file McapWriter.h
/// \brief Writes a bag of ROS 2 as one MCAP file.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/file/AtomicFile.h"
#include "io/file/Bytes.h"
#include "io/rosbag/McapFile.h"

namespace polemcl::io {

/// \brief A topic to write.
struct McapTopic {
  std::string name;      ///< "/pose"
  std::string type;      ///< "geometry_msgs/msg/PoseStamped"
  std::string schema;    ///< the definition of the type as `ros2msg`, see rosSchema()
  bool latched = false;  ///< who subscribes later gets the last message too
};

/// \brief Messages go into chunks, compressed with Zstandard, with indexes, checksums and a
/// summary. One chunk and some bytes for each message of it are in memory, and 100 bytes for each
/// chunk before it. The same messages give the same bytes. The file appears with commit().
class McapWriter {
 public:
  /// \throws Error as AtomicFile.
  explicit McapWriter(const std::filesystem::path& file);

  /// \brief \return The number of its channel.
  std::uint16_t addTopic(const McapTopic& topic);
  /// \param time When it was recorded and published, ns since 1970.
  /// \param message In CDR.
  void add(std::uint16_t channel, std::uint64_t time, std::string_view message);
  /// \brief Completes the file. Call it once. \throws Error when it cannot be written.
  void commit();

 private:
  /// Time and place of each message of a channel in the chunk.
  using ChunkIndex = std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>>;
  struct Times {
    std::uint64_t first = 0, last = 0;  ///< 0 without messages
    std::uint64_t messages = 0;
    void add(std::uint64_t time);
  };
  void write(std::string_view bytes);
  void writeRecord(McapOpcode opcode, std::string_view content);
  void writeChunk();
  std::string writeMessageIndexes();
  void writeSummary();
  std::string statistics() const;

  AtomicFile m_file;
  std::uint64_t m_size = 0;  ///< bytes written
  std::uint32_t m_checksum = 0;
  std::map<std::string, std::uint16_t> m_schemaIds;   ///< by type
  std::string m_schemas, m_channels, m_chunkIndexes;  ///< records for the summary
  std::map<std::uint16_t, std::uint64_t> m_counts;    ///< messages of each channel
  std::uint32_t m_chunks = 0;
  Times m_times;
  ByteWriter m_chunk;
  Times m_chunkTimes;
  ChunkIndex m_chunkIndex;
};

}  // namespace polemcl::io
