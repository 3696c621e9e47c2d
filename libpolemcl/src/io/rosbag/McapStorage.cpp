#include <zlib.h>

#include <algorithm>
#include <map>
#include <utility>

#include <polemcl/core/common/Types.h>
#include "io/file/Bytes.h"
#include "io/file/Decompress.h"
#include "io/rosbag/BagStorage.h"
#include "io/rosbag/McapFile.h"

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kMessageHeader = 22;  ///< channel, sequence, two times
constexpr std::size_t kNoChunk = SIZE_MAX;

struct McapSchema {
  std::string name, encoding;
};
struct McapChannel {
  std::uint16_t schema = 0;
  std::string topic, format;
};
struct McapChunk {
  McapRecord record;
  bool indexed = false;  ///< all its index records are in the file
};
struct McapMessage {
  std::size_t chunk = kNoChunk;
  std::uint64_t offset = 0;  ///< in the chunk or in the file
  std::uint64_t time = 0;
  std::uint16_t channel = 0;
};

void requireChecksum(std::string_view bytes, std::uint32_t expected, const std::string& where) {
  if (expected == 0) return;  // it was not computed
  const uLong found = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  if (found != expected) throw Error(where + "damaged: its checksum is wrong");
}

class McapStorage : public BagStorage {
 public:
  explicit McapStorage(const fs::path& file);
  std::vector<StoredTopic> topics() const override;
  std::vector<std::int64_t> messages(std::int64_t topic) const override;
  std::string read(std::int64_t message, std::size_t most, const std::string& where) const override;
  std::string note() const override;

 private:
  void scan();
  void takeRecord(const McapRecord& record);
  void addSchema(const std::string& content);
  void addChannel(const std::string& content);
  void addIndex(const std::string& content);
  void addMessage(std::string_view header, std::size_t chunk, std::uint64_t offset);
  void checkSummary(const McapRecord& footer) const;
  void completeIndex();
  bool needsScan(std::size_t chunk) const;
  void scanChunk(std::size_t chunk);
  void listTopics();
  std::string decompress(std::size_t chunk) const;
  const std::string& content(std::size_t chunk) const;
  std::string placeOf(const McapRecord& chunk) const;

  McapFile m_file;
  std::map<std::uint16_t, McapSchema> m_schemas;
  std::map<std::uint16_t, McapChannel> m_channels;
  std::vector<McapChunk> m_chunks;
  std::vector<std::vector<McapMessage>> m_inChunks;  ///< for each chunk
  std::vector<McapMessage> m_messages;               ///< the id of a message is its number, from 1
  std::uint64_t m_scanned = 0;  ///< bytes of chunks that were decompressed to find their messages
  std::vector<StoredTopic> m_topics;
  std::map<std::uint16_t, std::int64_t> m_topicOf;  ///< id of the topic of a channel
  mutable std::size_t m_open = kNoChunk;            ///< chunk that was decompressed last
  mutable std::string m_content;
};

McapStorage::McapStorage(const fs::path& file) : m_file(file) {
  scan();
  completeIndex();
  listTopics();
}

/// Goes through the records of the file without those in chunks.
void McapStorage::scan() {
  std::uint64_t offset = kMcapMagic;
  bool inIndex = false;
  while (const auto record = m_file.recordAt(offset)) {
    // A chunk is indexed if another record follows its index: the recorder was not killed in it.
    const bool isIndex = record->opcode == McapOpcode::messageIndex;
    if (inIndex && !isIndex) m_chunks.back().indexed = true;
    inIndex = isIndex && !m_chunks.empty();
    takeRecord(*record);
    if (record->opcode == McapOpcode::footer) return;
    offset = record->end();
  }
}

void McapStorage::takeRecord(const McapRecord& record) {
  switch (record.opcode) {
    case McapOpcode::schema:
      return addSchema(m_file.read(record));
    case McapOpcode::channel:
      return addChannel(m_file.read(record));
    case McapOpcode::message:
      return addMessage(m_file.read(record, kMessageHeader), kNoChunk, record.begin - kMcapPrefix);
    case McapOpcode::chunk:
      m_chunks.push_back({record, false});
      m_inChunks.emplace_back();
      return;
    case McapOpcode::messageIndex:
      return addIndex(m_file.read(record));
    case McapOpcode::footer:
      return checkSummary(record);
    default:
      return;  // not needed
  }
}

void McapStorage::addSchema(const std::string& content) {
  ByteReader reader(content, m_file.where() + "schema ");
  const auto id = reader.get<std::uint16_t>();
  const std::string name(reader.getText()), encoding(reader.getText());
  m_schemas[id] = {name, encoding};
}

void McapStorage::addChannel(const std::string& content) {
  ByteReader reader(content, m_file.where() + "channel ");
  const auto id = reader.get<std::uint16_t>(), schema = reader.get<std::uint16_t>();
  const std::string topic(reader.getText()), format(reader.getText());
  m_channels[id] = {schema, topic, format};
}

void McapStorage::addIndex(const std::string& content) {
  if (m_chunks.empty()) throw Error(m_file.where() + "damaged: an index before the first chunk");
  ByteReader reader(content, m_file.where() + "message index ");
  const auto channel = reader.get<std::uint16_t>();
  ByteReader entries(reader.getText(), m_file.where() + "message index ");
  while (entries.remaining() > 0) {
    const auto time = entries.get<std::uint64_t>(), offset = entries.get<std::uint64_t>();
    m_inChunks.back().push_back({m_chunks.size() - 1, offset, time, channel});
  }
}

void McapStorage::addMessage(std::string_view header, std::size_t chunk, std::uint64_t offset) {
  ByteReader reader(header, m_file.where() + "message at byte " + std::to_string(offset) + ' ');
  const auto channel = reader.get<std::uint16_t>();
  reader.get<std::uint32_t>();  // its number
  const auto time = reader.get<std::uint64_t>();
  reader.get<std::uint64_t>();  // when it was published
  auto& list = chunk == kNoChunk ? m_messages : m_inChunks[chunk];
  list.push_back({chunk, offset, time, channel});
}

void McapStorage::checkSummary(const McapRecord& footer) const {
  const std::string content = m_file.read(footer);
  ByteReader reader(content, m_file.where() + "footer ");
  const auto start = reader.get<std::uint64_t>();
  reader.get<std::uint64_t>();  // where the offsets of the summary begin
  const auto checksum = reader.get<std::uint32_t>();
  const std::uint64_t end = footer.begin + 16;
  if (start > end) throw Error(m_file.where() + "damaged: its summary begins after its end");
  if (start > 0)
    requireChecksum(m_file.read(start, end - start), checksum, m_file.where() + "summary ");
}

/// Collects the messages of all chunks. Chunks without a usable index are decompressed.
void McapStorage::completeIndex() {
  for (std::size_t i = 0; i < m_chunks.size(); ++i) {
    auto& messages = m_inChunks[i];
    if (needsScan(i)) scanChunk(i);
    std::sort(messages.begin(), messages.end(),
              [](const McapMessage& a, const McapMessage& b) { return a.offset < b.offset; });
    const auto twice = std::adjacent_find(
        messages.begin(), messages.end(),
        [](const McapMessage& a, const McapMessage& b) { return a.offset == b.offset; });
    if (twice != messages.end())
      throw Error(placeOf(m_chunks[i].record) + "damaged: its index names a message twice");
    m_messages.insert(m_messages.end(), messages.begin(), messages.end());
  }
  m_inChunks.clear();
  for (const McapMessage& message : m_messages)
    if (m_channels.count(message.channel) == 0)
      throw Error(m_file.where() + "damaged: a message of the unknown channel " +
                  std::to_string(message.channel));
}

bool McapStorage::needsScan(std::size_t chunk) const {
  const auto& messages = m_inChunks[chunk];
  return !m_chunks[chunk].indexed ||
         std::any_of(messages.begin(), messages.end(), [&](const McapMessage& message) {
           const auto channel = m_channels.find(message.channel);
           return channel == m_channels.end() ||
                  (channel->second.schema != 0 && m_schemas.count(channel->second.schema) == 0);
         });
}

void McapStorage::scanChunk(std::size_t chunk) {
  m_inChunks[chunk].clear();
  const std::string& records = content(chunk);
  const std::string where = placeOf(m_chunks[chunk].record);
  m_scanned += records.size();
  if (m_scanned > mostInflated(m_file.size()))
    throw Error(where + "damaged: up to here the chunks hold more than a file of " +
                std::to_string(m_file.size()) + " bytes can");
  for (std::uint64_t offset = 0; offset < records.size();) {
    const McapRecord record = mcapRecordAt(records, offset, where);
    const std::string_view bytes = std::string_view(records).substr(record.begin, record.size);
    if (record.opcode == McapOpcode::schema) addSchema(std::string(bytes));
    if (record.opcode == McapOpcode::channel) addChannel(std::string(bytes));
    if (record.opcode == McapOpcode::message)
      addMessage(bytes.substr(0, kMessageHeader), chunk, offset);
    offset = record.end();
  }
}

/// Several channels may have one topic.
void McapStorage::listTopics() {
  requireFewTopics(m_channels.size(), m_file.where());
  for (const auto& [id, channel] : m_channels) {
    const McapSchema& schema = m_schemas[channel.schema];  // none: empty
    std::string format = channel.format;
    if (!schema.encoding.empty() && schema.encoding != "ros2msg" && schema.encoding != "ros2idl")
      format += " with a schema in " + schema.encoding;
    const auto isOf = [&channel = channel, &schema, &format](const StoredTopic& other) {
      return other.name == channel.topic && other.type == schema.name && other.format == format;
    };
    auto topic = std::find_if(m_topics.begin(), m_topics.end(), isOf);
    if (topic == m_topics.end()) {
      m_topics.push_back(
          {static_cast<std::int64_t>(m_topics.size()) + 1, channel.topic, schema.name, format, 0});
      topic = m_topics.end() - 1;
    }
    m_topicOf[id] = topic->id;
  }
  for (const McapMessage& message : m_messages)
    ++m_topics[static_cast<std::size_t>(m_topicOf[message.channel]) - 1].messages;
}

std::vector<StoredTopic> McapStorage::topics() const {
  return m_topics;
}

std::vector<std::int64_t> McapStorage::messages(std::int64_t topic) const {
  std::vector<std::int64_t> result;
  for (std::size_t i = 0; i < m_messages.size(); ++i)
    if (m_topicOf.at(m_messages[i].channel) == topic)
      result.push_back(static_cast<std::int64_t>(i) + 1);
  const auto time = [&](std::int64_t id) {
    return m_messages[static_cast<std::size_t>(id) - 1].time;
  };
  std::stable_sort(result.begin(), result.end(),
                   [&](std::int64_t a, std::int64_t b) { return time(a) < time(b); });
  return result;
}

std::string McapStorage::read(std::int64_t id, std::size_t most, const std::string& where) const {
  const auto index = static_cast<std::size_t>(id) - 1;
  if (index >= m_messages.size()) throw Error(where + "there is no such message");
  const McapMessage& message = m_messages[index];
  const bool inFile = message.chunk == kNoChunk;
  McapRecord record = inFile ? *m_file.recordAt(message.offset)
                             : mcapRecordAt(content(message.chunk), message.offset, where);
  const bool isMessage = record.opcode == McapOpcode::message && record.size >= kMessageHeader;
  if (!isMessage) throw Error(where + "damaged: its index points to something else");
  record.begin += kMessageHeader;
  record.size = std::min<std::uint64_t>(record.size - kMessageHeader, most);
  return inFile ? m_file.read(record) : content(message.chunk).substr(record.begin, record.size);
}

std::string McapStorage::note() const {
  if (m_file.isComplete()) return {};
  return m_file.where() + "the end is missing, the recording was cut short; " +
         std::to_string(m_messages.size()) + " messages before it are read";
}

const std::string& McapStorage::content(std::size_t chunk) const {
  if (m_open != chunk) {
    m_open = kNoChunk;
    m_content = decompress(chunk);
    m_open = chunk;
  }
  return m_content;
}

std::string McapStorage::placeOf(const McapRecord& chunk) const {
  return m_file.where() + "chunk at byte " + std::to_string(chunk.begin - kMcapPrefix) + ": ";
}

std::string McapStorage::decompress(std::size_t chunk) const {
  const std::string where = placeOf(m_chunks[chunk].record);
  const std::string bytes = m_file.read(m_chunks[chunk].record);
  ByteReader reader(bytes, where);
  reader.getRaw(16);  // times of the first and last message
  const auto size = reader.get<std::uint64_t>();
  const auto checksum = reader.get<std::uint32_t>();
  const std::string_view compression = reader.getText();
  const std::string_view data = reader.getRaw(reader.get<std::uint64_t>());
  if (const std::uint64_t most = mostInBag(data.size()); size > most)
    throw Error(where + std::to_string(size) + " bytes; up to " + std::to_string(most) +
                " are allowed");
  std::string records;
  if (data.empty() || compression.empty())
    records = data;
  else if (compression == "zstd")
    records = decompressedZstd(data, size, where);
  else if (compression == "lz4")
    records = decompressedLz4(data, size, where);
  else
    throw Error(where + "compressed with " + std::string(compression) +
                "; lz4 and zstd are allowed, ros2 bag convert writes them");
  if (records.size() != size)
    throw Error(where + "damaged: " + std::to_string(records.size()) + " bytes instead of " +
                std::to_string(size));
  requireChecksum(records, checksum, where);
  return records;
}

}  // namespace

std::unique_ptr<BagStorage> openMcapStorage(const fs::path& file) {
  return std::make_unique<McapStorage>(file);
}

}  // namespace polemcl::io
