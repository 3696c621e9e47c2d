#include "io/rosbag/Bag.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <string>
#include <utility>

#include <polemcl/core/common/Types.h>
#include "io/file/Decompress.h"
#include "io/file/TextFile.h"

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

/// The first versions of ROS 2 write "sensor_msgs/Imu" for "sensor_msgs/msg/Imu".
std::string currentName(std::string type) {
  const auto slash = type.find('/');
  if (slash != std::string::npos && type.find('/', slash + 1) == std::string::npos)
    type.insert(slash, "/msg");
  return type;
}

constexpr const char* kAdviceToConvert =
    "; write it as an uncompressed bag in MCAP or SQLite with ros2 bag convert";

/// What `metadata.yaml` says of the files.
struct BagMetadata {
  std::string storage, compression, mode;
  std::vector<std::string> files;
};

/// The text without spaces and quotes around it.
std::string unquoted(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && (text.front() == '"' || text.front() == '\'') &&
      text.front() == text.back())
    text = text.substr(1, text.size() - 2);
  return std::string(text);
}

BagMetadata readBagMetadata(const fs::path& file) {
  BagMetadata result;
  bool inList = false;
  for (const std::string& line : readLines(file)) {
    const std::string_view text = trimmed(line);
    if (inList && text.substr(0, 2) == "- ") {
      result.files.push_back(unquoted(text.substr(2)));
      continue;
    }
    const auto colon = text.find(':');
    if (text.empty() || colon == std::string_view::npos) continue;
    const std::string_view key = text.substr(0, colon);
    const std::string value = unquoted(text.substr(colon + 1));
    inList = key == "relative_file_paths";
    if (key == "storage_identifier") result.storage = value;
    if (key == "compression_format") result.compression = value;
    if (key == "compression_mode") result.mode = value;
  }
  return result;
}

/// Whether each message is compressed by itself. \throws Error when the compression is not zstd, or
/// the bag has another storage.
bool messagesCompressed(const fs::path& file, const BagMetadata& metadata) {
  if (!metadata.storage.empty() && metadata.storage != "sqlite3" && metadata.storage != "mcap")
    throw Error(file.string() + ": the storage of the bag is " + metadata.storage +
                kAdviceToConvert);
  const std::string& mode = metadata.mode;
  const bool eachMessage = mode == "MESSAGE" || mode == "message";
  if (eachMessage && metadata.compression == "zstd") return true;
  const bool uncompressed = mode.empty() || mode == "NONE" || mode == "none";
  const bool wholeFiles = mode == "FILE" || mode == "file";  // unpackedFile() judges these
  if (wholeFiles && metadata.compression == "zstd") return false;
  if (!metadata.compression.empty() || !uncompressed)
    throw Error(file.string() + ": the bag is compressed (" + metadata.compression + ", " + mode +
                ")" + kAdviceToConvert);
  return false;
}

/// Whether the file is compressed as a whole.
bool isPacked(const fs::path& file) {
  return file.extension() == ".zstd" || file.extension() == ".zst";
}

/// The unpacked file beside a compressed one, if it is there; else the file itself.
fs::path unpackedFile(const fs::path& file) {
  if (!isPacked(file)) return file;
  const fs::path unpacked = fs::path(file).replace_extension();
  return fs::is_regular_file(unpacked) ? unpacked : file;
}

bool begins(const fs::path& file, std::string_view text) {
  std::string begin(text.size(), '\0');
  std::ifstream(file, std::ios::binary)
      .read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin == text;
}

void requireBagFile(const fs::path& file) {
  if (file.extension() == ".db3" || file.extension() == ".mcap") return;
  if (isPacked(file))
    throw Error(file.string() + ": the file is compressed as a whole (zstd); unpack it: zstd -d " +
                file.string() + " -o " + fs::path(file).replace_extension().string());
  if (file.filename() == "metadata.yaml")
    throw Error(file.string() + ": name the folder of the bag, which this file is in");
  if (begins(file, "#ROSBAG V"))
    throw Error(file.string() + ": a bag of ROS 1; rosbag2rawlog of MRPT reads its clouds");
  throw Error(file.string() + ": not a .db3 or .mcap file of a ROS 2 bag" + kAdviceToConvert);
}

void requireContent(const fs::path& file) {
  if (begins(file, "version https://git-lfs"))
    throw Error(file.string() + ": a pointer of Git LFS, not the bag: fetch it with git lfs pull");
}

/// The number before the extension: 12 for "drive_12.db3"; 0 without one.
std::uint64_t numberInName(const fs::path& file) {
  const std::string stem = file.stem().string();
  std::size_t begin = stem.size();
  while (begin > 0 && stem.size() - begin < 18 &&
         std::isdigit(static_cast<unsigned char>(stem[begin - 1])))
    --begin;
  return begin == stem.size() ? 0 : std::stoull(stem.substr(begin));
}

/// All files of a folder without a list of them.
std::vector<fs::path> listedBagFiles(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path& file = entry.path();
    const bool isBag = file.extension() == ".db3" || file.extension() == ".mcap";
    if (isBag || (isPacked(file) && unpackedFile(file) == file)) files.push_back(file);
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return std::make_pair(numberInName(a), a) < std::make_pair(numberInName(b), b);
  });
  if (files.empty())
    throw Error(folder.string() + ": no .db3 or .mcap file in it; name the folder of a ROS 2 bag");
  return files;
}

BagFiles filesOfBag(const fs::path& folder) {
  const fs::path file = folder / "metadata.yaml";
  BagMetadata metadata;
  if (fs::exists(file)) metadata = readBagMetadata(file);
  BagFiles result;
  result.compressedMessages = messagesCompressed(file, metadata);
  const fs::path absolute = fs::absolute(folder);
  if (metadata.files.empty()) {
    result.files = listedBagFiles(absolute);
    return result;
  }
  // Old versions of rosbag2 write the name of the folder before that of the file.
  for (const std::string& name : metadata.files)
    result.files.push_back(unpackedFile(absolute / fs::path(name).filename()));
  return result;
}

}  // namespace

void requireFewTopics(std::size_t topics, const std::string& where) {
  constexpr std::size_t kMostTopics = 10000;
  if (topics > kMostTopics)
    throw Error(where + std::to_string(topics) + " topics; up to " + std::to_string(kMostTopics) +
                " are allowed");
}

BagFiles bagFiles(const fs::path& bag) {
  if (!fs::exists(bag)) throw Error(bag.string() + ": there is no such bag");
  BagFiles result = fs::is_directory(bag) ? filesOfBag(bag) : BagFiles{{fs::absolute(bag)}, false};
  for (const fs::path& file : result.files) {
    requireBagFile(file);
    if (!fs::is_regular_file(file))
      throw Error(file.string() + ": missing, although metadata.yaml of the bag names it");
    requireContent(file);
  }
  return result;
}

Bag::Bag(const fs::path& bag) : m_path(bag) {
  const BagFiles files = bagFiles(bag);
  m_compressed = files.compressedMessages;
  for (const fs::path& file : files.files) open(file);
  if (m_topics.empty() && !m_leftOut.empty())
    throw Error(bag.string() + ": no messages in the format cdr, only " + joined(m_leftOut) +
                "; record it with ROS 2");
  sortTopics();
}

void Bag::open(const fs::path& path) {
  m_files.push_back(
      {path, path.extension() == ".mcap" ? openMcapStorage(path) : openSqliteStorage(path), {}});
  File& file = m_files.back();
  const std::vector<StoredTopic> topics = file.storage->topics();
  requireFewTopics(topics.size(), path.string() + ": ");
  for (const StoredTopic& topic : topics) addTopic(file, topic);
}

void Bag::addTopic(File& file, const StoredTopic& topic) {
  // Some programs leave the format empty.
  if (!topic.format.empty() && topic.format != "cdr") {
    m_leftOut.insert(topic.name + " (" + topic.format + ")");
    return;
  }
  const std::string type = currentName(topic.type);
  auto known = std::find_if(m_topics.begin(), m_topics.end(),
                            [&](const BagTopic& other) { return other.name == topic.name; });
  if (known == m_topics.end()) {
    m_topics.push_back({topic.name, type, 0});
    known = m_topics.end() - 1;
  }
  if (known->type != type)
    throw Error(file.path.string() + ": " + topic.name + " has two types, " + known->type +
                " and " + type + "; leave one of them out with ros2 bag convert");
  known->messages += topic.messages;
  file.topicIds.resize(m_topics.size());
  file.topicIds[static_cast<std::size_t>(known - m_topics.begin())] = topic.id;
}

void Bag::sortTopics() {
  std::vector<std::size_t> order(m_topics.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return m_topics[a].name < m_topics[b].name; });
  std::vector<BagTopic> topics;
  topics.reserve(order.size());
  for (const std::size_t i : order) topics.push_back(m_topics[i]);
  for (File& file : m_files) {
    file.topicIds.resize(order.size());
    std::vector<std::int64_t> ids;
    ids.reserve(order.size());
    for (const std::size_t i : order) ids.push_back(file.topicIds[i]);
    file.topicIds = std::move(ids);
  }
  m_topics = std::move(topics);
}

std::vector<BagMessage> Bag::messages(std::size_t topic) const {
  std::vector<BagMessage> result;
  for (std::size_t i = 0; i < m_files.size(); ++i)
    for (const std::int64_t id : m_files[i].storage->messages(m_files[i].topicIds[topic]))
      result.push_back({i, topic, id});
  const BagTopic& counted = m_topics[topic];
  if (result.size() != counted.messages)  // an index of SQLite may lack messages that are there
    throw Error(m_path.string() + ": " + counted.name + ": damaged: it has " +
                std::to_string(counted.messages) + " messages, but lists " +
                std::to_string(result.size()) + "; write it anew with ros2 bag convert");
  return result;
}

BagMessage Bag::message(std::size_t topic, const fs::path& file, std::int64_t id) const {
  for (std::size_t i = 0; i < m_files.size(); ++i)
    if (m_files[i].path == file) return {i, topic, id};
  throw Error(file.string() + ": not a file of the bag " + m_path.string());
}

std::string Bag::read(const BagMessage& message, std::size_t most) const {
  const BagStorage& storage = *m_files[message.file].storage;
  const std::string where = place(message);
  if (!m_compressed) return storage.read(message.id, most, where);
  const std::string compressed = storage.read(message.id, SIZE_MAX, where);
  std::string bytes = decompressedZstd(compressed, mostInBag(compressed.size()), where);
  if (bytes.size() > most) bytes.resize(most);
  return bytes;
}

std::vector<std::string> Bag::notes() const {
  std::vector<std::string> result;
  for (const File& file : m_files)
    if (const std::string note = file.storage->note(); !note.empty()) result.push_back(note);
  if (!m_leftOut.empty())
    result.push_back(m_path.string() +
                     ": topics in other formats than cdr are left out: " + joined(m_leftOut));
  return result;
}

const fs::path& Bag::file(const BagMessage& message) const {
  return m_files[message.file].path;
}

std::string Bag::place(const BagMessage& message) const {
  return file(message).string() + ": " + m_topics[message.topic].name + ", message " +
         std::to_string(message.id) + ": ";
}

}  // namespace polemcl::io
