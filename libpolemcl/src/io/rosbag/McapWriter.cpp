#include "io/rosbag/McapWriter.h"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>

#include <polemcl/core/common/Types.h>

namespace polemcl::io {

namespace {

constexpr std::size_t kChunkBytes = 1 << 20;  ///< a chunk is written once it has as many
constexpr int kLevel = 3;                     ///< of Zstandard
/// QoS of a latched topic, as rosbag2 stores it: the last message, reliable, transient local.
constexpr const char* kLatchedQos =
    "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n"
    "  deadline:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  liveliness: 1\n"
    "  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  avoid_ros_namespace_conventions: false";

std::uint32_t checksumOf(std::string_view bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

void putRecord(ByteWriter& writer, McapOpcode opcode, std::string_view content) {
  writer.put(static_cast<std::uint8_t>(opcode));
  writer.put(static_cast<std::uint64_t>(content.size()));
  writer.putRaw(content);
}

std::string recordOf(McapOpcode opcode, std::string_view content) {
  ByteWriter writer;
  putRecord(writer, opcode, content);
  return writer.bytes();
}

std::string compressedZstd(std::string_view data) {
  std::string result(ZSTD_compressBound(data.size()), '\0');
  const std::size_t size =
      ZSTD_compress(result.data(), result.size(), data.data(), data.size(), kLevel);
  if (ZSTD_isError(size))
    throw Error(std::string("a chunk of the bag cannot be compressed: ") + ZSTD_getErrorName(size));
  result.resize(size);
  return result;
}

std::string schemaRecord(std::uint16_t id, const McapTopic& topic) {
  ByteWriter writer;
  writer.put(id);
  writer.putText(topic.type);
  writer.putText("ros2msg");
  writer.putText(topic.schema);
  return recordOf(McapOpcode::schema, writer.bytes());
}

std::string channelRecord(std::uint16_t id, std::uint16_t schema, const McapTopic& topic) {
  ByteWriter metadata, writer;
  if (topic.latched) {
    metadata.putText("offered_qos_profiles");
    metadata.putText(kLatchedQos);
  }
  writer.put(id);
  writer.put(schema);
  writer.putText(topic.name);
  writer.putText("cdr");
  writer.putText(metadata.bytes());
  return recordOf(McapOpcode::channel, writer.bytes());
}

}  // namespace

void McapWriter::Times::add(std::uint64_t time) {
  first = messages == 0 ? time : std::min(first, time);
  last = std::max(last, time);
  ++messages;
}

McapWriter::McapWriter(const std::filesystem::path& file) : m_file(file) {
  ByteWriter header;
  header.putText("ros2");
  header.putText("polemcl");
  write(kMcapMagicBytes);
  writeRecord(McapOpcode::header, header.bytes());
}

std::uint16_t McapWriter::addTopic(const McapTopic& topic) {
  const auto id = static_cast<std::uint16_t>(m_counts.size() + 1);
  const auto [schema, isNew] =
      m_schemaIds.emplace(topic.type, static_cast<std::uint16_t>(m_schemaIds.size() + 1));
  if (isNew) {
    const std::string record = schemaRecord(schema->second, topic);
    m_schemas += record;
    m_chunk.putRaw(record);
  }
  const std::string channel = channelRecord(id, schema->second, topic);
  m_counts[id] = 0;
  m_channels += channel;
  m_chunk.putRaw(channel);
  return id;
}

void McapWriter::add(std::uint16_t channel, std::uint64_t time, std::string_view message) {
  ByteWriter content;
  content.put(channel);
  content.put(static_cast<std::uint32_t>(m_counts.at(channel)++));
  content.put(time);
  content.put(time);
  content.putRaw(message);
  m_chunkIndex[channel].emplace_back(time, m_chunk.bytes().size());
  m_times.add(time);
  m_chunkTimes.add(time);
  putRecord(m_chunk, McapOpcode::message, content.bytes());
  if (m_chunk.bytes().size() >= kChunkBytes) writeChunk();
}

void McapWriter::write(std::string_view bytes) {
  m_file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  m_size += bytes.size();
  m_checksum = checksumOf(bytes, m_checksum);
}

void McapWriter::writeRecord(McapOpcode opcode, std::string_view content) {
  write(recordOf(opcode, content));
}

void McapWriter::writeChunk() {
  const std::string& records = m_chunk.bytes();
  const std::string data = compressedZstd(records);
  ByteWriter chunk;
  chunk.put(m_chunkTimes.first);
  chunk.put(m_chunkTimes.last);
  chunk.put(static_cast<std::uint64_t>(records.size()));
  chunk.put(checksumOf(records));
  chunk.putText("zstd");
  chunk.put(static_cast<std::uint64_t>(data.size()));
  chunk.putRaw(data);
  const std::uint64_t begin = m_size;
  writeRecord(McapOpcode::chunk, chunk.bytes());

  const std::uint64_t end = m_size;
  const std::string offsets = writeMessageIndexes();
  ByteWriter summary;
  for (const std::uint64_t value : {m_chunkTimes.first, m_chunkTimes.last, begin, end - begin})
    summary.put(value);
  summary.putText(offsets);
  summary.put(m_size - end);
  summary.putText("zstd");
  summary.put(static_cast<std::uint64_t>(data.size()));
  summary.put(static_cast<std::uint64_t>(records.size()));
  m_chunkIndexes += recordOf(McapOpcode::chunkIndex, summary.bytes());
  ++m_chunks;
  m_chunk = {};
  m_chunkIndex.clear();
  m_chunkTimes = {};
}

/// For each channel of the chunk. Returns where each one is.
std::string McapWriter::writeMessageIndexes() {
  ByteWriter offsets;
  for (auto& [channel, entries] : m_chunkIndex) {
    std::stable_sort(entries.begin(), entries.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    ByteWriter list, index;
    for (const auto& [time, offset] : entries) {
      list.put(time);
      list.put(offset);
    }
    index.put(channel);
    index.putText(list.bytes());
    offsets.put(channel);
    offsets.put(m_size);
    writeRecord(McapOpcode::messageIndex, index.bytes());
  }
  return offsets.bytes();
}

std::string McapWriter::statistics() const {
  ByteWriter counts, writer;
  for (const auto& [channel, count] : m_counts) {
    counts.put(channel);
    counts.put(count);
  }
  writer.put(m_times.messages);
  writer.put(static_cast<std::uint16_t>(m_schemaIds.size()));
  writer.put(static_cast<std::uint32_t>(m_counts.size()));
  writer.put(std::uint32_t{0});  // attachments
  writer.put(std::uint32_t{0});  // metadata
  writer.put(m_chunks);
  writer.put(m_times.first);
  writer.put(m_times.last);
  writer.putText(counts.bytes());
  return recordOf(McapOpcode::statistics, writer.bytes());
}

void McapWriter::writeSummary() {
  const std::uint64_t begin = m_size;
  m_checksum = 0;
  ByteWriter offsets;
  const std::pair<McapOpcode, std::string> groups[] = {{McapOpcode::schema, m_schemas},
                                                       {McapOpcode::channel, m_channels},
                                                       {McapOpcode::statistics, statistics()},
                                                       {McapOpcode::chunkIndex, m_chunkIndexes}};
  for (const auto& [opcode, records] : groups) {
    if (records.empty()) continue;
    ByteWriter offset;
    offset.put(static_cast<std::uint8_t>(opcode));
    offset.put(m_size);
    offset.put(static_cast<std::uint64_t>(records.size()));
    putRecord(offsets, McapOpcode::summaryOffset, offset.bytes());
    write(records);
  }
  const std::uint64_t offsetsBegin = m_size;
  write(offsets.bytes());
  // The checksum covers the footer up to itself.
  ByteWriter footer;
  footer.put(static_cast<std::uint8_t>(McapOpcode::footer));
  footer.put(std::uint64_t{20});  // size of its content
  footer.put(begin);
  footer.put(offsetsBegin);
  write(footer.bytes());
  ByteWriter checksum;
  checksum.put(m_checksum);
  write(checksum.bytes());
  write(kMcapMagicBytes);
}

void McapWriter::commit() {
  if (!m_chunk.bytes().empty()) writeChunk();
  ByteWriter end;
  end.put(m_checksum);
  writeRecord(McapOpcode::dataEnd, end.bytes());
  writeSummary();
  m_file.commit();
}

}  // namespace polemcl::io
