#include <sqlite3.h>

#include <algorithm>
#include <functional>

#include <polemcl/core/common/Types.h>
#include "io/rosbag/BagStorage.h"

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
  std::string uri = "file://";
  for (const char c : fs::absolute(file).string()) {
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

class SqliteStorage : public BagStorage {
 public:
  explicit SqliteStorage(const fs::path& file)
      : m_file(file),
        m_bytes(fs::file_size(file) + unmergedBytes(file)),
        m_database(openDatabase(file)) {}
  std::vector<StoredTopic> topics() const override;
  std::vector<std::int64_t> messages(std::int64_t topic) const override;
  std::string read(std::int64_t message, std::size_t most, const std::string& where) const override;

 private:
  fs::path m_file;
  std::uintmax_t m_bytes;
  Database m_database;
};

std::vector<StoredTopic> SqliteStorage::topics() const {
  std::vector<StoredTopic> result;
  // The table `topics` may name topics without messages.
  forEachRow(
      m_file, m_database.get(),
      "SELECT id, name, type, serialization_format, coalesce(number, 0) FROM topics LEFT JOIN "
      "(SELECT topic_id, count(*) AS number FROM messages GROUP BY topic_id) ON topic_id = id",
      0, [&](sqlite3_stmt* row) {
        result.push_back({sqlite3_column_int64(row, 0), columnText(row, 1), columnText(row, 2),
                          columnText(row, 3),
                          static_cast<std::size_t>(sqlite3_column_int64(row, 4))});
      });
  return result;
}

std::vector<std::int64_t> SqliteStorage::messages(std::int64_t topic) const {
  std::vector<std::int64_t> result;
  forEachRow(m_file, m_database.get(),
             "SELECT id FROM messages WHERE topic_id = ? ORDER BY timestamp, id", topic,
             [&](sqlite3_stmt* row) { result.push_back(sqlite3_column_int64(row, 0)); });
  return result;
}

std::string SqliteStorage::read(std::int64_t message, std::size_t most,
                                const std::string& where) const {
  sqlite3* const database = m_database.get();
  const auto fail = [&] { return Error(where + sqlite3_errmsg(database)); };
  sqlite3_blob* handle = nullptr;
  const int opened = sqlite3_blob_open(database, "main", "messages", "data", message, 0, &handle);
  const std::unique_ptr<sqlite3_blob, int (*)(sqlite3_blob*)> blob(handle, &sqlite3_blob_close);
  if (opened != SQLITE_OK) throw fail();
  const auto size = static_cast<std::size_t>(sqlite3_blob_bytes(handle));
  if (size > m_bytes)
    throw Error(where + "damaged: " + std::to_string(size) + " bytes, more than its file has");
  std::string bytes(std::min(size, most), '\0');
  if (sqlite3_blob_read(handle, bytes.data(), static_cast<int>(bytes.size()), 0) != SQLITE_OK)
    throw fail();
  return bytes;
}

}  // namespace

std::unique_ptr<BagStorage> openSqliteStorage(const fs::path& file) {
  return std::make_unique<SqliteStorage>(file);
}

}  // namespace polemcl::io
