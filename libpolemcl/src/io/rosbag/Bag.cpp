#include "io/rosbag/Bag.h"

#include <sqlite3.h>

#include <algorithm>
#include <functional>
#include <utility>

#include <polemcl/core/common/Types.h>
#include "io/rosbag/BagFiles.h"

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

using Database = std::unique_ptr<sqlite3, int (*)(sqlite3*)>;

/// Size of the changes that were not yet merged into the file; SQLite keeps them beside it.
std::uintmax_t unmergedBytes(const fs::path& file) {
  const fs::path changes = file.string() + "-wal";
  return fs::exists(changes) ? fs::file_size(changes) : 0;
}

/// The path as SQLite takes it, with the promise that nobody writes to the file. Without that,
/// SQLite puts files beside it. With changes that were not yet merged into the file, it must.
std::string uriOf(const fs::path& file) {
  std::string uri = "file:";
  for (const char c : file.string()) {
    if (c == '%' || c == '?' || c == '#') {
      constexpr const char* kDigits = "0123456789abcdef";
      uri += {'%', kDigits[c >> 4], kDigits[c & 15]};
    } else {
      uri += c;
    }
  }
  return uri + (unmergedBytes(file) > 0 ? "" : "?immutable=1");
}

[[noreturn]] void failIn(const fs::path& file, sqlite3* database) {
  throw Error(file.string() + ": cannot be read as a ROS 2 bag: " + sqlite3_errmsg(database));
}

Database openDatabase(const fs::path& file) {
  sqlite3* handle = nullptr;
  const int status = sqlite3_open_v2(uriOf(file).c_str(), &handle,
                                     SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
  Database database(handle, &sqlite3_close);
  if (status != SQLITE_OK) failIn(file, handle);
  return database;
}

/// Calls `visit` for each row of a query, with `topic` in the place of its parameter, if it has
/// one.
void forEachRow(const fs::path& file, sqlite3* database, const std::string& sql, std::int64_t topic,
                const std::function<void(sqlite3_stmt*)>& visit) {
  sqlite3_stmt* handle = nullptr;
  if (sqlite3_prepare_v2(database, sql.c_str(), -1, &handle, nullptr) != SQLITE_OK)
    failIn(file, database);
  const std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement(handle, &sqlite3_finalize);
  if (sqlite3_bind_parameter_count(handle) > 0) sqlite3_bind_int64(handle, 1, topic);
  int status = SQLITE_ROW;
  while ((status = sqlite3_step(handle)) == SQLITE_ROW) visit(handle);
  if (status != SQLITE_DONE) failIn(file, database);
}

std::string columnText(sqlite3_stmt* row, int column) {
  const auto* const begin = sqlite3_column_text(row, column);
  return begin ? std::string(reinterpret_cast<const char*>(begin),
                             static_cast<std::size_t>(sqlite3_column_bytes(row, column)))
               : std::string();
}

/// The first versions of ROS 2 write "sensor_msgs/Imu" for "sensor_msgs/msg/Imu".
std::string currentName(std::string type) {
  const auto slash = type.find('/');
  if (slash != std::string::npos && type.find('/', slash + 1) == std::string::npos)
    type.insert(slash, "/msg");
  return type;
}

}  // namespace

Bag::Bag(const fs::path& bag) : m_path(bag) {
  for (const fs::path& file : bagFiles(bag)) open(file);
  sortTopics();
}

void Bag::open(const fs::path& path) {
  m_files.push_back({path, fs::file_size(path) + unmergedBytes(path), openDatabase(path), {}});
  File& file = m_files.back();
  // The table `topics` may name topics without messages.
  forEachRow(
      path, file.database.get(),
      "SELECT id, name, type, serialization_format, coalesce(number, 0) FROM topics LEFT JOIN "
      "(SELECT topic_id, count(*) AS number FROM messages GROUP BY topic_id) ON topic_id = id",
      0, [&](sqlite3_stmt* row) {
        const BagTopic topic{columnText(row, 1), currentName(columnText(row, 2)),
                             static_cast<std::size_t>(sqlite3_column_int64(row, 4))};
        addTopic(file, sqlite3_column_int64(row, 0), topic, columnText(row, 3));
      });
}

void Bag::addTopic(File& file, std::int64_t id, const BagTopic& topic, const std::string& format) {
  // Some programs leave the format empty.
  if (!format.empty() && format != "cdr")
    throw Error(file.path.string() + ": " + topic.name + ": messages in the format " + format +
                "; cdr is allowed, ros2 bag convert writes it");
  auto known = std::find_if(m_topics.begin(), m_topics.end(),
                            [&](const BagTopic& other) { return other.name == topic.name; });
  if (known == m_topics.end()) {
    m_topics.push_back({topic.name, topic.type, 0});
    known = m_topics.end() - 1;
  }
  if (known->type != topic.type)
    throw Error(file.path.string() + ": " + topic.name + " has two types, " + known->type +
                " and " + topic.type + "; leave one of them out with ros2 bag convert");
  known->messages += topic.messages;
  file.topicIds.resize(m_topics.size());
  file.topicIds[static_cast<std::size_t>(known - m_topics.begin())] = id;
}

void Bag::sortTopics() {
  std::vector<std::size_t> order(m_topics.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return m_topics[a].name < m_topics[b].name; });
  std::vector<BagTopic> topics;
  for (const std::size_t i : order) topics.push_back(m_topics[i]);
  for (File& file : m_files) {
    file.topicIds.resize(order.size());
    std::vector<std::int64_t> ids;
    for (const std::size_t i : order) ids.push_back(file.topicIds[i]);
    file.topicIds = std::move(ids);
  }
  m_topics = std::move(topics);
}

std::vector<BagMessage> Bag::messages(std::size_t topic) const {
  std::vector<BagMessage> result;
  for (std::size_t i = 0; i < m_files.size(); ++i) {
    const File& file = m_files[i];
    forEachRow(file.path, file.database.get(),
               "SELECT id FROM messages WHERE topic_id = ? ORDER BY timestamp, id",
               file.topicIds[topic], [&](sqlite3_stmt* row) {
                 result.push_back({i, topic, sqlite3_column_int64(row, 0)});
               });
  }
  return result;
}

BagMessage Bag::message(std::size_t topic, const fs::path& file, std::int64_t id) const {
  for (std::size_t i = 0; i < m_files.size(); ++i)
    if (m_files[i].path == file) return {i, topic, id};
  throw Error(file.string() + ": not a file of the bag " + m_path.string());
}

std::string Bag::read(const BagMessage& message, std::size_t most) const {
  const File& file = m_files[message.file];
  sqlite3* const database = file.database.get();
  const auto fail = [&] { return Error(place(message) + sqlite3_errmsg(database)); };
  sqlite3_blob* handle = nullptr;
  const int opened =
      sqlite3_blob_open(database, "main", "messages", "data", message.id, 0, &handle);
  const std::unique_ptr<sqlite3_blob, int (*)(sqlite3_blob*)> blob(handle, &sqlite3_blob_close);
  if (opened != SQLITE_OK) throw fail();
  const auto size = static_cast<std::size_t>(sqlite3_blob_bytes(handle));
  if (size > file.bytes)
    throw Error(place(message) + "damaged: " + std::to_string(size) +
                " bytes, more than its file has");
  std::string bytes(std::min(size, most), '\0');
  if (sqlite3_blob_read(handle, bytes.data(), static_cast<int>(bytes.size()), 0) != SQLITE_OK)
    throw fail();
  return bytes;
}

const fs::path& Bag::file(const BagMessage& message) const {
  return m_files[message.file].path;
}

std::string Bag::place(const BagMessage& message) const {
  return file(message).string() + ": " + m_topics[message.topic].name + ", message " +
         std::to_string(message.id) + ": ";
}

}  // namespace polemcl::io
