#include "io/rosbag/McapFile.h"

#include <algorithm>

#include <polemcl/core/common/Types.h>
#include "io/file/Bytes.h"

namespace polemcl::io {

namespace {

McapRecord parsePrefix(std::string_view prefix, std::uint64_t offset) {
  return {static_cast<McapOpcode>(prefix.front()), offset + kMcapPrefix,
          loadLittleEndian<std::uint64_t>(prefix.data() + 1)};
}

bool recordFits(const McapRecord& record, std::uint64_t end) {
  return static_cast<int>(record.opcode) != 0 && record.size <= end - record.begin;
}

[[noreturn]] void failWithoutRecord(std::uint64_t offset, const std::string& where) {
  throw Error(where + "damaged: there is no whole record at byte " + std::to_string(offset));
}

}  // namespace

McapRecord mcapRecordAt(std::string_view records, std::uint64_t offset, const std::string& where) {
  if (offset > records.size() || records.size() - offset < kMcapPrefix)
    failWithoutRecord(offset, where);
  const McapRecord record = parsePrefix(records.substr(offset, kMcapPrefix), offset);
  if (!recordFits(record, records.size())) failWithoutRecord(offset, where);
  return record;
}

McapFile::McapFile(const std::filesystem::path& file)
    : m_where(file.string() + ": "),
      m_stream(file, std::ios::binary),
      m_end(std::filesystem::file_size(file)) {
  if (m_end < kMcapMagic || read(0, kMcapMagic) != kMcapMagicBytes)
    throw Error(m_where + "cannot be read as a ROS 2 bag: it does not begin as MCAP, version 0");
  m_complete = m_end >= 2 * kMcapMagic && read(m_end - kMcapMagic, kMcapMagic) == kMcapMagicBytes;
  if (m_complete) m_end -= kMcapMagic;
}

std::optional<McapRecord> McapFile::recordAt(std::uint64_t offset) const {
  const bool hasPrefix = m_end - offset >= kMcapPrefix;
  if (hasPrefix) {
    const McapRecord record = parsePrefix(read(offset, kMcapPrefix), offset);
    if (recordFits(record, m_end)) return record;
  }
  if (m_complete) failWithoutRecord(offset, m_where);
  return std::nullopt;
}

std::string McapFile::read(const McapRecord& record, std::uint64_t most) const {
  return read(record.begin, std::min(record.size, most));
}

std::string McapFile::read(std::uint64_t offset, std::uint64_t size) const {
  if (offset > m_end || size > m_end - offset) failWithoutRecord(offset, m_where);
  std::string bytes(size, '\0');
  m_stream.clear();
  m_stream.seekg(static_cast<std::streamoff>(offset));
  if (!m_stream.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw Error(m_where + "cannot be read at byte " + std::to_string(offset));
  return bytes;
}

}  // namespace polemcl::io
