#include "io/file/GrowingFile.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include <polemcl/core/common/Types.h>

namespace polemcl::io {
namespace {

void write(const std::filesystem::path& file, std::string_view text, std::ios::openmode mode) {
  errno = 0;
  std::ofstream stream(file, std::ios::binary | mode);
  stream << text;
  stream.close();
  if (!stream)
    throw Error("cannot write " + file.string() + ": " +
                (errno != 0 ? std::strerror(errno) : "a write failed"));
}

}  // namespace

GrowingFile::GrowingFile(std::filesystem::path file) : m_file(std::move(file)) {
  write(m_file, {}, std::ios::trunc);
}

void GrowingFile::add(std::string_view text) {
  m_collected += text;
  if (m_collected.size() >= kPiece) flush();
}

void GrowingFile::flush() {
  if (m_collected.empty()) return;
  write(m_file, m_collected, std::ios::app);
  m_collected.clear();
}

}  // namespace polemcl::io
