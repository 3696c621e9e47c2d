#include "cli/OutputFolder.h"

#include <unistd.h>

#include <algorithm>

#include <polemcl/core/common/Types.h>

namespace polemcl::apps {
namespace fs = std::filesystem;
namespace {

/// "out/" names the same folder as "out".
fs::path withoutSlash(const fs::path& path) {
  const fs::path full = fs::absolute(path).lexically_normal();
  return full.has_filename() ? full : full.parent_path();
}

void refuseForeign(const fs::path& target, const std::string& what,
                   const std::vector<std::string>& known, const std::string& marker) {
  const std::string advice = ", so it is not replaced; choose another folder or remove it";
  if (!fs::exists(fs::symlink_status(target))) return;
  if (!fs::is_directory(fs::symlink_status(target)))
    throw Error(target.string() + ": exists and is not a folder" + advice);
  if (fs::is_empty(target)) return;
  for (const auto& entry : fs::directory_iterator(target)) {
    const std::string name = entry.path().filename().string();
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(target.string() + ": holds more than " + what + " (" + name + ")" + advice);
  }
  if (!fs::exists(target / marker))
    throw Error(target.string() + ": is no earlier output (no " + marker + ")" + advice);
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& target, const std::string& what,
                           const std::vector<std::string>& known, const std::string& marker)
    : m_target(withoutSlash(target)) {
  try {
    refuseForeign(m_target, what, known, marker);
    m_temporary = m_target;
    m_temporary += "." + std::to_string(::getpid()) + ".tmp";
    io::removeLeftovers(m_target);
    if (!fs::create_directory(m_temporary))
      throw Error(m_temporary.string() + ": exists already; remove it");
    m_lock = io::PathLock(m_temporary);
  } catch (const fs::filesystem_error& error) {
    throw Error(m_target.string() + ": cannot be created: " + error.code().message());
  }
}

OutputFolder::~OutputFolder() {
  if (m_temporary.empty()) return;
  std::error_code ignored;
  fs::remove_all(m_temporary, ignored);
}

void OutputFolder::commit() {
  try {
    fs::path old;
    if (fs::exists(m_target)) {  // aside first, so that there is never half of each
      old = m_temporary;
      old += ".old";
      fs::rename(m_target, old);
    }
    std::error_code failure;
    fs::rename(m_temporary, m_target, failure);
    if (failure) {
      if (!old.empty()) fs::rename(old, m_target);
      throw Error(m_target.string() + ": cannot be completed: " + failure.message());
    }
    m_temporary.clear();
    if (!old.empty()) fs::remove_all(old);
  } catch (const fs::filesystem_error& error) {
    throw Error(m_target.string() + ": cannot be replaced: " + error.code().message());
  }
}

}  // namespace polemcl::apps
