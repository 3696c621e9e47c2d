#pragma once
/// \file McapFile.h
/// \brief The records of an MCAP file (mcap.dev), as they lie in it.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

namespace polemcl::io {

enum class McapOpcode : std::uint8_t {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  messageIndex = 7,
  chunkIndex = 8,
  statistics = 11,
  summaryOffset = 14,
  dataEnd = 15
};

/// \brief Where the content of a record lies, in the file or in a decompressed chunk.
struct McapRecord {
  McapOpcode opcode;
  std::uint64_t begin = 0, size = 0;
  std::uint64_t end() const { return begin + size; }
};

/// \brief Opcode and size before the content of each record.
constexpr std::uint64_t kMcapPrefix = 9;
/// \brief The magic bytes at the begin and at the end, and their number.
constexpr std::uint64_t kMcapMagic = 8;
constexpr std::string_view kMcapMagicBytes("\x89MCAP0\r\n", kMcapMagic);

/// \brief The record at `offset` of decompressed records. \throws Error when it does not fit.
McapRecord mcapRecordAt(std::string_view records, std::uint64_t offset, const std::string& where);

/// \brief An MCAP file that is open for reading.
class McapFile {
 public:
  /// \throws Error when it cannot be read or does not begin as MCAP.
  explicit McapFile(const std::filesystem::path& file);
  /// \brief False for a recorder that was killed: the magic bytes at the end are missing.
  bool isComplete() const { return m_complete; }
  /// \brief The record at `offset`; nothing where an incomplete file ends.
  /// \throws Error when it goes beyond the end of a complete file, or its opcode is not valid.
  std::optional<McapRecord> recordAt(std::uint64_t offset) const;
  /// \brief The first `most` bytes of the content of a record.
  std::string read(const McapRecord& record, std::uint64_t most = UINT64_MAX) const;
  /// \brief Bytes of the file. \throws Error when it is shorter.
  std::string read(std::uint64_t offset, std::uint64_t size) const;
  /// \brief Bytes of the file up to the end of its records.
  std::uint64_t size() const { return m_end; }
  /// \brief "FILE: ", the prefix of an error.
  const std::string& where() const { return m_where; }

 private:
  std::string m_where;
  mutable std::ifstream m_stream;
  std::uint64_t m_end = 0;  ///< of the records
  bool m_complete = false;
};

}  // namespace polemcl::io
