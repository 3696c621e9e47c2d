#include "cli/OutputFolder.h"

#include <fcntl.h>
#include <fnmatch.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include <polemcl/core/common/Types.h>
#include "io/file/AtomicFile.h"

namespace polemcl::apps {
namespace fs = std::filesystem;
namespace {

/// "out/" names the same folder as "out".
fs::path withoutSlash(const fs::path& path) {
  const fs::path full = fs::absolute(path).lexically_normal();
  return full.has_filename() ? full : full.parent_path();
}

/// Renames a folder. An earlier one in that place gets the other name at the same moment.
std::error_code takePlace(const fs::path& from, const fs::path& to) {
  std::error_code failure;
  fs::rename(from, to, failure);
  if (failure.value() != ENOTEMPTY && failure.value() != EEXIST) return failure;
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) return {};
  if (errno != EINVAL && errno != ENOSYS) return {errno, std::generic_category()};
  // A file system that cannot do that, such as NFS: for a moment nothing has the name.
  const fs::path old = from.string() + ".old";
  fs::rename(to, old, failure);
  if (failure) return failure;
  fs::rename(from, to, failure);
  std::error_code ignored;
  fs::rename(old, failure ? to : from, ignored);
  return failure;
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& target, const std::string& what,
                           const std::vector<std::string>& known, const std::string& marker)
    : m_target(withoutSlash(target)), m_what(what), m_marker(marker), m_known(known) {
  try {
    refuseForeign();
    io::removeLeftovers(m_target, [&](const fs::path& path) {
      return fs::is_directory(fs::symlink_status(path)) && foreignIn(path, true).empty();
    });
    for (unsigned number = 0;; ++number) {
      m_temporary = m_target;
      m_temporary += "." + std::to_string(::getpid()) + "-" + std::to_string(number) + ".tmp";
      if (!fs::create_directory(m_temporary)) continue;  // of another machine's process
      m_lock = io::PathLock(m_temporary);
      if (!m_lock.isOfAnother() && fs::exists(m_temporary)) return;  // else taken for a leftover
    }
  } catch (const fs::filesystem_error& error) {
    throw Error(m_target.string() + ": cannot be created: " + error.code().message());
  }
}

OutputFolder::~OutputFolder() {
  if (m_temporary.empty()) return;
  std::error_code ignored;
  fs::remove_all(m_temporary, ignored);
}

/// The first entry below a folder that is no output; empty without one.
std::string OutputFolder::foreignIn(const fs::path& folder, bool isUnderWay) const {
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    const auto fits = [&](const std::string& pattern) {
      return ::fnmatch(pattern.c_str(), name.c_str(), FNM_PATHNAME) == 0 ||
             (isUnderWay && io::isTemporaryOf(pattern, name));
    };
    if (std::none_of(m_known.begin(), m_known.end(), fits)) return name;
  }
  return {};
}

void OutputFolder::refuseForeign() const {
  const std::string advice = ", so it is not replaced; choose another folder or remove it";
  if (!fs::exists(fs::symlink_status(m_target))) return;
  if (!fs::is_directory(fs::symlink_status(m_target)))
    throw Error(m_target.string() + ": exists and is not a folder" + advice);
  if (fs::is_empty(m_target)) return;
  const std::string foreign = foreignIn(m_target, false);
  if (!foreign.empty())
    throw Error(m_target.string() + ": holds more than " + m_what + " (" + foreign + ")" + advice);
  if (!fs::exists(m_target / m_marker))
    throw Error(m_target.string() + ": is no earlier output (no " + m_marker + ")" + advice);
}

void OutputFolder::commit() {
  io::syncAll(m_temporary);
  refuseForeign();
  if (const auto failure = takePlace(m_temporary, m_target))
    throw Error(m_target.string() + ": cannot be completed: " + failure.message());
  io::syncFolder(m_target.parent_path());  // before an earlier output goes
  std::error_code ignored;
  fs::remove_all(m_temporary, ignored);
  m_temporary.clear();
}

}  // namespace polemcl::apps
