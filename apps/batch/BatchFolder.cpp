#include "batch/BatchFolder.h"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>

#include <polemcl/core/common/Types.h>
#include "cli/JsonFile.h"
#include "io/file/AtomicFile.h"
#include "io/file/Bytes.h"

namespace polemcl::apps {
namespace fs = std::filesystem;
namespace {

constexpr const char* kMarker = "plan.json";
constexpr const char* kLock = ".lock";
constexpr const char* kFolders[] = {"tasks", "logs", "failed", "times", "settings", "files"};

std::uint32_t checksumOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(file.string() + ": cannot be read");
  std::array<char, 1 << 16> block;
  uLong crc = 0;
  while (stream.read(block.data(), block.size()) || stream.gcount() > 0)
    crc = ::crc32(crc, reinterpret_cast<const Bytef*>(block.data()),
                  static_cast<uInt>(stream.gcount()));
  if (!stream.eof() || stream.bad()) throw Error(file.string() + ": cannot be read to its end");
  return static_cast<std::uint32_t>(crc);
}

bool isDoneNote(const Json& done) {
  const auto has = [](const Json& object, const char* key, auto isOfItsKind) {
    return object.is_object() && object.contains(key) && isOfItsKind(object.at(key));
  };
  const auto isText = [](const Json& value) { return value.is_string(); };
  const auto isNumber = [](const Json& value) { return value.is_number_unsigned(); };
  const auto isOutput = [&](const Json& output) {
    return has(output, "file", isText) && has(output, "bytes", isNumber) &&
           has(output, "crc32", isNumber);
  };
  return has(done, "key", isText) && (!done.contains("build") || has(done, "build", isText)) &&
         has(done, "outputs", [&](const Json& outputs) {
           return outputs.is_array() && std::all_of(outputs.begin(), outputs.end(), isOutput);
         });
}

/// Discarded when there is no such file, or no JSON in it.
Json noteIn(const fs::path& file) {
  try {
    return readJson(file);
  } catch (const Error&) {
    return Json::value_t::discarded;
  }
}

/// Discarded also when it is not what commit() writes.
Json doneIn(const fs::path& folder) {
  Json done = noteIn(folder / "done.json");
  return isDoneNote(done) ? done : Json(Json::value_t::discarded);
}

/// What is wrong with an output; empty when nothing is.
std::string damage(const fs::path& folder, const Json& output) {
  const fs::path file = folder / output.at("file").get<std::string>();
  std::error_code none;
  if (!fs::is_regular_file(file, none)) return file.string() + " is missing";
  if (fs::file_size(file, none) != output.at("bytes").get<std::uintmax_t>() ||
      checksumOf(file) != output.at("crc32").get<std::uint32_t>())
    return file.string() + " is not what was written";
  return {};
}

void createFolder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw Error(folder.string() + ": cannot be created: " + failure.message());
}

/// A folder of somebody else must not lead to files outside of it.
void requireNoLinks(const fs::path& folder, bool recursive) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.is_symlink(none))
      throw Error(entry.path().string() +
                  ": is a link, as no batch makes any; remove it, or choose another --output");
    if (recursive && entry.is_directory(none)) requireNoLinks(entry.path(), false);
  }
}

/// A batch that was cut short before its plan was written: it holds what store() writes, and
/// nothing else.
bool isBegun(const fs::path& folder) {
  std::error_code none;
  if (!fs::is_regular_file(folder / kLock, none)) return false;
  const auto isOurs = [](const fs::directory_entry& entry) {
    const std::string name = entry.path().filename().string();
    return name == kLock || name == "batch.ini" || io::isTemporaryOf("batch.ini", name) ||
           io::isTemporaryOf(kMarker, name) ||
           std::find(std::begin(kFolders), std::end(kFolders), name) != std::end(kFolders);
  };
  return std::all_of(fs::directory_iterator(folder), {}, isOurs);
}

/// Names of computers in names of files.
std::string host() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  return name.data();
}

}  // namespace

BatchFolder::BatchFolder(const fs::path& path) : m_path(fs::absolute(path).lexically_normal()) {
  if (fs::exists(m_path / kMarker) || fs::exists(m_path / kLock)) requireNoLinks(m_path, true);
}

void BatchFolder::take(const std::string& name, bool resume) {
  const bool known = fs::exists(m_path / kMarker);
  if (!known && fs::exists(m_path) &&
      (!fs::is_directory(m_path) || !(fs::is_empty(m_path) || isBegun(m_path))))
    throw Error(m_path.string() + ": exists and holds no batch; choose another --output");
  if (known && !resume)
    throw Error(m_path.string() +
                ": holds a batch already; continue it with --resume, or choose another "
                "--output");
  createFolder(m_path);
  const fs::path lock = m_path / kLock;
  const int descriptor = ::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) throw Error(lock.string() + ": cannot be written: " + std::strerror(errno));
  m_lock = io::PathLock(descriptor);
  if (!m_lock.isHeld())
    throw Error(m_path.string() + ": a batch is under way in this folder; wait for it, or stop it");
  if (!known) return;
  std::string there;
  try {
    there = readPlan(m_path / kMarker).name;
  } catch (const Error&) {
    return;  // a plan that was damaged is written anew
  }
  if (there != name)
    throw Error(m_path.string() + ": holds the batch '" + there + "', not '" + name +
                "'; choose another --output");
}

void BatchFolder::store(const BatchPlan& plan, const fs::path& batchFile) {
  std::error_code none;
  fs::remove_all(m_path / "failed", none);  // of earlier attempts
  for (const char* folder : kFolders) createFolder(m_path / folder);
  sweep();
  for (const auto& [name, content] : plan.files) io::writeFile(m_path / name, content);
  io::writeFile(m_path / "batch.ini", io::readBytes(batchFile));
  writePlan(m_path / kMarker, plan);
}

bool BatchFolder::isDone(const BatchTask& task) const {
  const Json done = doneIn(work(task.id));
  return done.is_object() && done.value("key", "") == task.key;
}

std::string BatchFolder::buildOf(const BatchTask& task) const {
  const Json done = doneIn(work(task.id));
  return done.is_object() ? done.value("build", "an earlier version") : "";
}

void BatchFolder::sweep() const {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(m_path / "tasks", none))
    if (entry.path().extension() == ".part") fs::remove_all(entry.path(), none);
}

BatchFolder::State BatchFolder::state(const BatchTask& task, std::string* why) const {
  const fs::path folder = work(task.id);
  std::error_code none;
  if (!fs::exists(folder, none)) return State::open;
  const auto damaged = [&](const std::string& what) {
    if (why) *why = what;
    return State::damaged;
  };
  const std::string changed = (folder / "done.json").string() + " is not what was written";
  const Json done = doneIn(folder);
  if (!done.is_object()) return damaged(changed);
  if (done.at("key") != task.key) return State::open;
  if (done.at("outputs").size() != task.outputs.size()) return damaged(changed);
  for (const auto& output : done.at("outputs"))
    if (const std::string wrong = damage(folder, output); !wrong.empty()) return damaged(wrong);
  return State::done;
}

fs::path BatchFolder::part(const BatchTask& task) const {
  return work(task.id).string() + "." + host() + "-" + std::to_string(::getpid()) + ".part";
}

fs::path BatchFolder::stage(const BatchTask& task) const {
  fs::path folder = part(task);
  std::error_code none;
  fs::remove_all(folder, none);
  createFolder(folder);
  return folder;
}

void BatchFolder::commit(const BatchTask& task, const fs::path& staged) const {
  const fs::path kept = staged / ".kept";  // so that what is not an output goes
  Json done;
  done["key"] = task.key;
  done["outputs"] = Json::array();
  for (const auto& output : task.outputs) {
    if (!fs::is_regular_file(staged / output))
      throw Error("it did not write " + output +
                  (fs::path(output).extension() == ".tum"
                       ? ": no true poses are known; give them with [sessions] poses"
                       : ""));
    createFolder((kept / output).parent_path());
    fs::rename(staged / output, kept / output);
    done["outputs"].push_back({{"file", output},
                               {"bytes", fs::file_size(kept / output)},
                               {"crc32", checksumOf(kept / output)}});
  }
  writeJson(kept / "done.json", done);
  io::syncAll(kept);
  std::error_code failure;
  fs::rename(kept, work(task.id), failure);
  // On a cluster, a task that was taken for dead may have ended after all: the bytes are the same.
  if (failure && state(task) != State::done)
    throw Error(work(task.id).string() + ": cannot be completed: " + failure.message());
  io::syncFolder(m_path / "tasks");
  std::error_code none;
  fs::remove_all(staged, none);
  fs::remove(m_path / "failed" / (task.id + ".json"), none);
}

void BatchFolder::remove(const BatchTask& task) const {
  const fs::path aside = part(task);  // so that half of it never has its name
  std::error_code failure;
  fs::remove_all(aside, failure);
  fs::rename(work(task.id), aside, failure);
  if (failure == std::errc::no_such_file_or_directory) return;
  if (!failure) fs::remove_all(aside, failure);
  if (failure) throw Error(work(task.id).string() + ": cannot be removed: " + failure.message());
}

void BatchFolder::noteFailure(const BatchTask& task, const std::string& reason) const {
  try {
    writeJson(m_path / "failed" / (task.id + ".json"), Json{{"task", task.id}, {"reason", reason}});
  } catch (const std::exception&) {
    // A full disk, or a folder that is gone: the one who asked has been told, and the task counts
    // as open.
  }
}

void BatchFolder::noteTime(const std::string& task, double seconds) const {
  try {
    io::writeFile(m_path / "times" / task, std::to_string(seconds) + '\n');
  } catch (const std::exception&) {
    // The task is done; only its time is not known.
  }
}

double BatchFolder::seconds(const std::string& task) const {
  double seconds = 0;
  const bool known = static_cast<bool>(std::ifstream(m_path / "times" / task) >> seconds);
  return known ? seconds : std::numeric_limits<double>::quiet_NaN();
}

std::string BatchFolder::failure(const std::string& task) const {
  const Json note = noteIn(m_path / "failed" / (task + ".json"));
  return note.is_object() ? note.value("reason", "") : "";
}

}  // namespace polemcl::apps
