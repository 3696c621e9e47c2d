#include "mrpt/rawlog/GzReadStream.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "io/file/ReadLimits.h"
#include "mrpt/rawlog/PointCountGuard.h"

namespace polemcl {

struct GzReadStream::Impl {
  gzFile file = nullptr;
  std::vector<unsigned char> buffer = std::vector<unsigned char>(1 << 18);
  std::size_t begin = 0, end = 0;  ///< range not consumed yet
  PointCountGuard points;
};

GzReadStream::GzReadStream(const std::string& path)
    : m_path(path), m_impl(std::make_unique<Impl>()) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw Error(path + ": no such file");
  if (!std::filesystem::is_regular_file(path, error)) throw Error(path + ": is not a file");
  m_fileSize = std::filesystem::file_size(path, error);
  m_impl->file = gzopen(path.c_str(), "rb");
  if (!m_impl->file) throw Error(path + ": cannot be opened: " + std::strerror(errno));
  gzbuffer(m_impl->file, 1 << 18);
}

GzReadStream::~GzReadStream() {
  if (m_impl->file) gzclose(m_impl->file);
}

/// Makes bytes available; false at the end of the data, clean or damaged.
bool GzReadStream::refill() {
  Impl& impl = *m_impl;
  if (impl.begin < impl.end) return true;
  const int got = gzread(impl.file, impl.buffer.data(), static_cast<unsigned>(impl.buffer.size()));
  int code = Z_OK;
  gzerror(impl.file, &code);
  if (code == Z_ERRNO) throw Error(m_path + ": cannot be read: " + std::strerror(errno));
  // Z_BUF_ERROR: truncated gzip data; Z_DATA_ERROR: damaged data or wrong checksum.
  if (got <= 0 && code != Z_OK && code != Z_STREAM_END) m_cutShort = true;
  impl.begin = 0;
  impl.end = got > 0 ? static_cast<std::size_t>(got) : 0;
  return got > 0;
}

/// Upper bound of the bytes that are left.
std::uint64_t GzReadStream::mostLeft() const {
  if (gzdirect(m_impl->file)) return m_fileSize - std::min(m_fileSize, m_position);
  constexpr std::uint64_t buffered = 1 << 20;  // by zlib and by this class
  const auto at = static_cast<std::uint64_t>(std::max<z_off_t>(0, gzoffset(m_impl->file)));
  return buffered + io::greatestDeflateRatio * (m_fileSize - std::min(m_fileSize, at));
}

bool GzReadStream::atCleanEnd() {
  return !refill() && !m_cutShort;
}

std::size_t GzReadStream::Read(void* buffer, std::size_t count) {
  auto* out = static_cast<unsigned char*>(buffer);
  std::size_t done = 0;
  while (done < count) {
    if (!refill()) {
      m_cutShort = true;
      throw std::runtime_error("the data ends here");
    }
    const std::size_t piece = std::min(count - done, m_impl->end - m_impl->begin);
    std::memcpy(out + done, m_impl->buffer.data() + m_impl->begin, piece);
    m_impl->begin += piece;
    m_position += piece;
    done += piece;
  }
  const auto points = m_impl->points.see(buffer, count);
  if (points && *points > mostLeft() / PointCountGuard::pointBytes) {
    m_cutShort = true;
    throw std::runtime_error("the data ends before its " + std::to_string(*points) + " points");
  }
  return done;
}

std::size_t GzReadStream::Write(const void*, std::size_t) {
  throw std::logic_error("a stream for reading only");
}

std::uint64_t GzReadStream::Seek(std::int64_t, TSeekOrigin) {
  throw std::logic_error("a stream without seeking");
}

double GzReadStream::progress() const {
  const auto at = gzoffset(m_impl->file);
  return m_fileSize == 0 || at < 0
             ? 1.0
             : std::min(1.0, static_cast<double>(at) / static_cast<double>(m_fileSize));
}

}  // namespace polemcl
