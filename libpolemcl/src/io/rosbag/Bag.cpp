#include "io/rosbag/Bag.h"

#include <algorithm>
#include <utility>

#include <polemcl/core/common/Types.h>
#include "io/file/Decompress.h"
#include "io/file/TextFile.h"
#include "io/rosbag/BagFiles.h"

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

}  // namespace

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
  for (const StoredTopic& topic : file.storage->topics()) addTopic(file, topic);
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
  std::string bytes =
      decompressedZstd(storage.read(message.id, SIZE_MAX, where), kMostInBag, where);
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
