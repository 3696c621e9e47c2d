#include "localize/RunFolder.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <regex>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "io/file/AtomicFile.h"

namespace polemcl::apps {

namespace fs = std::filesystem;

namespace {

constexpr const char* summaryName = "summary.json";
constexpr const char* kStaging = ".incomplete-";

std::vector<fs::path> entriesOf(const fs::path& folder) {
  std::vector<fs::path> entries;
  for (const auto& entry : fs::directory_iterator(folder)) entries.push_back(entry.path());
  std::sort(entries.begin(), entries.end());
  return entries;
}

/// What runs write, by name; what else is called `run_...`, others may have put there.
bool isOfARun(const fs::path& entry) {
  const std::string name = entry.filename().string();
  static const std::regex folder("run_[0-9]+_scenes"),
      file(R"(run_[0-9]+(\.tum|\.json|_errors\.csv|_cov\.csv|_health\.csv))");
  return std::regex_match(name, fs::is_directory(fs::symlink_status(entry)) ? folder : file);
}

bool isReplaced(const fs::path& file) {
  const fs::path name = file.filename();
  return isOfARun(file) || name == summaryName || name == "config.ini" || name == "timings.json";
}

}  // namespace

RunFolder::RunFolder(const fs::path& folder) : m_folder(folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    throw Error(folder.string() + ": is a file; the results need a folder");
  m_created = fs::create_directories(folder, error);
  if (error) throw Error(folder.string() + ": cannot create the folder: " + error.message());
  std::string pattern = (folder / (std::string(kStaging) + "XXXXXX")).string();
  if (!::mkdtemp(pattern.data())) {
    const std::string reason = std::strerror(errno);
    if (m_created) fs::remove(folder, error);
    throw Error(folder.string() + ": cannot write into the folder: " + reason);
  }
  m_staging = pattern;
  m_lock = io::PathLock(m_staging);
}

std::vector<fs::path> RunFolder::leftovers() const {
  return io::leftoversIn(m_folder, [&](const std::string& name) {
    return name.rfind(kStaging, 0) == 0 && name != m_staging.filename();
  });
}

RunFolder::~RunFolder() {
  std::error_code ignored;
  fs::remove_all(m_staging, ignored);
  if (m_created) fs::remove(m_folder, ignored);  // only if it is empty
}

void RunFolder::protect(const fs::path& input) const {
  if (input.empty()) return;
  std::error_code error;
  const auto isInHere = [&](const fs::path& file) {
    return isReplaced(file) && fs::equivalent(file.parent_path(), m_folder, error);
  };
  if (!isInHere(fs::absolute(input)) && !isInHere(fs::weakly_canonical(input, error))) return;
  throw Error(input.string() + ": is an input, and the results in " + m_folder.string() +
              " would replace it; choose another folder for them");
}

void RunFolder::requireFreeNames() const {
  for (const auto& entry : entriesOf(m_staging)) {
    const fs::path target = m_folder / entry.filename();
    const fs::file_status there = fs::symlink_status(target);
    const char* obstacle = nullptr;
    if (fs::is_directory(there) && !isOfARun(target)) obstacle = "a folder, and a result";
    if (fs::is_directory(entry) && fs::exists(there) && !fs::is_directory(there))
      obstacle = fs::is_symlink(there) ? "a link, and a folder of results"
                                       : "a file, and a folder of results";
    if (obstacle)
      throw Error(target.string() + ": is " + obstacle +
                  " has to go there; move it away. Nothing was replaced");
  }
}

void RunFolder::commit() {
  const auto turn = io::PathLock::waitFor(m_folder);  // another may write the same results
  requireFreeNames();
  io::syncAll(m_staging);
  try {
    fs::remove(m_folder / summaryName);
    io::syncFolder(m_folder);  // so that after a power cut, too, what has a summary is complete
    for (const auto& entry : entriesOf(m_folder))
      if (isOfARun(entry)) fs::remove_all(entry);
    for (const auto& entry : entriesOf(m_staging))
      if (entry.filename() != summaryName) fs::rename(entry, m_folder / entry.filename());
    io::syncFolder(m_folder);
    if (fs::exists(staged(summaryName))) fs::rename(staged(summaryName), m_folder / summaryName);
    io::syncFolder(m_folder);
  } catch (const fs::filesystem_error& error) {
    throw Error(m_folder.string() + ": cannot move the results in: " + error.code().message());
  }
}

}  // namespace polemcl::apps
