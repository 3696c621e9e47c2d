#include <sqlite3.h>

#include <algorithm>
#include <climits>
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

std::string columnText(sqlite3_stmt* row, int column) {
  const auto* const begin = sqlite3_column_text(row, column);
  return begin ? std::string(reinterpret_cast<const char*>(begin),
                             static_cast<std::size_t>(sqlite3_column_bytes(row, column)))
               : std::string();
}

/// While it lives, a query may take 100 steps for each byte of the file, and a million. A row has
/// at least six bytes and takes some 20 steps; more are needed where pages lead in circles.
class StepLimit {
 public:
  StepLimit(sqlite3* database, std::uintmax_t bytes)
      : m_database(database), m_left((1000000 + 100 * static_cast<std::int64_t>(bytes)) / kEvery) {
    const auto count = [](void* left) { return --*static_cast<std::int64_t*>(left) < 0 ? 1 : 0; };
    sqlite3_progress_handler(database, kEvery, count, &m_left);
  }
  ~StepLimit() { sqlite3_progress_handler(m_database, 0, nullptr, nullptr); }
  StepLimit(const StepLimit&) = delete;
  StepLimit& operator=(const StepLimit&) = delete;

 private:
  static constexpr int kEvery = 1000;
  sqlite3* m_database;
  std::int64_t m_left;  ///< thousands
};

/// Calls `visit` for each row of a query, with `topic` in the place of its parameter, if it has
/// one. \param bytes Size of the file.
void forEachRow(const fs::path& file, sqlite3* database, std::uintmax_t bytes,
                const std::string& sql, std::int64_t topic,
                const std::function<void(sqlite3_stmt*)>& visit) {
  const StepLimit limit(database, bytes);
  sqlite3_stmt* handle = nullptr;
  if (sqlite3_prepare_v2(database, sql.c_str(), -1, &handle, nullptr) != SQLITE_OK)
    failIn(file, database);
  const std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement(handle, &sqlite3_finalize);
  if (sqlite3_bind_parameter_count(handle) > 0) sqlite3_bind_int64(handle, 1, topic);
  int status = SQLITE_ROW;
  while ((status = sqlite3_step(handle)) == SQLITE_ROW) visit(handle);
  if (status == SQLITE_INTERRUPT)
    throw Error(file.string() + ": damaged: it has more rows than " + std::to_string(bytes) +
                " bytes can hold");
  if (status != SQLITE_DONE) failIn(file, database);
}

/// Nothing in the file may run longer or take more memory than its size allows: a view may be
/// an endless query, a column a call of a function.
void requirePlainTables(const fs::path& file, sqlite3* database, std::uintmax_t bytes) {
  constexpr std::uintmax_t kRoomForQueries = 4096;
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH,
                static_cast<int>(std::min<std::uintmax_t>(bytes + kRoomForQueries, INT_MAX)));
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  forEachRow(file, database, bytes,
             "SELECT name, type FROM pragma_table_list WHERE schema = 'main' AND type <> 'table' "
             "AND lower(name) IN ('topics', 'messages')",
             0, [&](sqlite3_stmt* row) {
               throw Error(file.string() + ": cannot be read as a ROS 2 bag: " +
                           columnText(row, 0) + " must be a table, no " + columnText(row, 1));
             });
}

class SqliteStorage : public BagStorage {
 public:
  explicit SqliteStorage(const fs::path& file)
      : m_file(file),
        m_bytes(fs::file_size(file) + unmergedBytes(file)),
        m_database(openDatabase(file)) {
    requirePlainTables(file, m_database.get(), m_bytes);
  }
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
      m_file, m_database.get(), m_bytes,
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
  forEachRow(m_file, m_database.get(), m_bytes,
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
