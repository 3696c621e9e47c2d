#pragma once
// Writes MCAP files byte by byte, as the format is published (mcap.dev).

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "io/file/Bytes.h"

namespace polemcl::tests {

inline const std::string mcapMagic("\x89MCAP0\r\n", 8);

inline std::string mcapRecord(int opcode, const std::string& content) {
  io::ByteWriter writer;
  writer.put(static_cast<std::uint8_t>(opcode));
  writer.put(static_cast<std::uint64_t>(content.size()));
  writer.putRaw(content);
  return writer.bytes();
}

inline std::uint32_t mcapChecksum(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

inline std::string mcapSchema(std::uint16_t id, const std::string& name,
                              const std::string& encoding = "ros2msg") {
  io::ByteWriter writer;
  writer.put(id);
  writer.putText(name);
  writer.putText(encoding);
  writer.putText("float64 x");
  return mcapRecord(3, writer.bytes());
}

inline std::string mcapChannel(std::uint16_t id, std::uint16_t schema, const std::string& topic,
                               const std::string& format = "cdr") {
  io::ByteWriter writer;
  writer.put(id);
  writer.put(schema);
  writer.putText(topic);
  writer.putText(format);
  writer.putText("");
  return mcapRecord(4, writer.bytes());
}

inline std::string mcapMessage(std::uint16_t channel, std::uint64_t time, const std::string& data) {
  io::ByteWriter writer;
  writer.put(channel);
  writer.put(std::uint32_t{0});
  writer.put(time);
  writer.put(time);
  writer.putRaw(data);
  return mcapRecord(5, writer.bytes());
}

inline std::string zstdFrame(const std::string& data) {
  std::string result(ZSTD_compressBound(data.size()), '\0');
  result.resize(ZSTD_compress(result.data(), result.size(), data.data(), data.size(), 3));
  return result;
}

inline std::string lz4Frame(const std::string& data) {
  std::string result(LZ4F_compressFrameBound(data.size(), nullptr), '\0');
  result.resize(
      LZ4F_compressFrame(result.data(), result.size(), data.data(), data.size(), nullptr));
  return result;
}

inline std::string mcapCompressed(const std::string& records, const std::string& compression) {
  if (compression == "zstd") return zstdFrame(records);
  return compression == "lz4" ? lz4Frame(records) : records;
}

/// A chunk whose fields may contradict its content.
inline std::string mcapRawChunk(const std::string& data, const std::string& compression,
                                std::uint64_t size, std::uint32_t checksum) {
  io::ByteWriter writer;
  writer.put(std::uint64_t{0});
  writer.put(std::uint64_t{0});
  writer.put(size);
  writer.put(checksum);
  writer.putText(compression);
  writer.put(static_cast<std::uint64_t>(data.size()));
  writer.putRaw(data);
  return mcapRecord(6, writer.bytes());
}

/// A chunk that is as it should be.
inline std::string mcapChunk(const std::string& records, const std::string& compression = "") {
  return mcapRawChunk(mcapCompressed(records, compression), compression, records.size(),
                      mcapChecksum(records));
}

/// The index of the messages of a channel in the chunk before. \param entries Time and offset.
inline std::string mcapIndex(std::uint16_t channel,
                             const std::vector<std::pair<std::uint64_t, std::uint64_t>>& entries) {
  io::ByteWriter list, writer;
  for (const auto& [time, offset] : entries) {
    list.put(time);
    list.put(offset);
  }
  writer.put(channel);
  writer.putText(list.bytes());
  return mcapRecord(7, writer.bytes());
}

/// The begin of a file, then its data section.
inline std::string mcapBegin(const std::string& data) {
  io::ByteWriter header;
  header.putText("ros2");
  header.putText("test");
  return mcapMagic + mcapRecord(1, header.bytes()) + data;
}

/// A whole file.
inline std::string mcapFile(const std::string& data, const std::string& summary = "",
                            std::uint32_t wrongBits = 0) {
  const std::string begin = mcapBegin(data) + mcapRecord(15, std::string(4, '\0'));
  io::ByteWriter footer;
  footer.put(static_cast<std::uint64_t>(summary.empty() ? 0 : begin.size()));
  footer.put(std::uint64_t{0});
  const std::string prefix = mcapRecord(2, std::string(20, '\0')).substr(0, 9);
  footer.put(mcapChecksum(summary + prefix + footer.bytes()) ^ wrongBits);
  return begin + summary + prefix + footer.bytes() + mcapMagic;
}

}  // namespace polemcl::tests
