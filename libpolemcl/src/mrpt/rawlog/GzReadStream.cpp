#include "mrpt/rawlog/GzReadStream.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string_view>
#include <thread>

#include <polemcl/core/common/Types.h>
#include "io/file/ReadLimits.h"

namespace polemcl {

namespace {

constexpr std::uint64_t kPointBytes = 12;  ///< a point has at least x, y and z

/// E.g. "mrpt::maps::CPointsMapXYZI", or "CSimplePointsMap" of old files.
bool isPointsMap(std::string_view name) {
  return name.find("PointsMap") != std::string_view::npos;
}

void refuseZstd(const std::string& path) {
  std::array<char, 4> head{};
  std::ifstream(path, std::ios::binary).read(head.data(), head.size());
  if (std::memcmp(head.data(), "\x28\xB5\x2F\xFD", head.size()) == 0)
    throw Error(path + ": is compressed with zstd, as MRPT from 2.15 on does; zstd -d makes a " +
                "rawlog of it that can be read here");
}

}  // namespace

GzReadStream::GzReadStream(const std::string& path, double follow)
    : m_path(path), m_follow(follow) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw Error(path + ": no such file");
  if (std::filesystem::is_directory(path, error))
    throw Error(path + ": is a folder, not a rawlog; pole-import makes a rawlog of a dataset");
  if (!std::filesystem::is_regular_file(path, error)) throw Error(path + ": is not a file");
  m_fileSize = std::filesystem::file_size(path, error);
  refuseZstd(path);
  m_file = gzopen(path.c_str(), "rb");
  if (!m_file) throw Error(path + ": cannot be opened: " + std::strerror(errno));
  gzbuffer(m_file, 1 << 18);
}

GzReadStream::~GzReadStream() {
  gzclose(m_file);
}

/// Makes bytes available; false at the end of the data, clean or damaged.
bool GzReadStream::refill() {
  if (m_begin < m_end) return true;
  int code = Z_OK;
  const int got = readPiece(code);
  if (code == Z_ERRNO) throw Error(m_path + ": cannot be read: " + std::strerror(errno));
  if (code == Z_MEM_ERROR) throw std::bad_alloc();
  // Z_BUF_ERROR: truncated gzip data; Z_DATA_ERROR: damaged data or wrong checksum.
  if (got <= 0 && (m_endsEarly || (code != Z_OK && code != Z_STREAM_END))) m_cutShort = true;
  m_endsEarly = got > 0 && code == Z_BUF_ERROR;  // zlib 1.3.2 does not tell it again
  m_begin = 0;
  m_end = got > 0 ? static_cast<std::size_t>(got) : 0;
  return got > 0;
}

/// What the file has now; at its end, what comes within the time of waiting.
int GzReadStream::readPiece(int& code) {
  const auto end = std::chrono::steady_clock::now() + m_follow;
  for (;;) {
    const int got = gzread(m_file, m_buffer.data(), static_cast<unsigned>(m_buffer.size()));
    gzerror(m_file, &code);
    const bool atEnd = got <= 0 && (code == Z_OK || code == Z_BUF_ERROR);
    if (!atEnd || m_isStopped || std::chrono::steady_clock::now() >= end) return got;
    gzclearerr(m_file);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

/// Upper bound of the bytes that are left.
std::uint64_t GzReadStream::mostLeft() const {
  if (gzdirect(m_file)) return m_fileSize - std::min(m_fileSize, m_position);
  constexpr std::uint64_t kBuffered = 1 << 20;  // by zlib and by this class
  const auto at = static_cast<std::uint64_t>(std::max<z_off_t>(0, gzoffset(m_file)));
  return kBuffered + io::kGreatestDeflateRatio * (m_fileSize - std::min(m_fileSize, at));
}

bool GzReadStream::atCleanEnd() {
  return !refill() && !m_cutShort;
}

/// The count of points, if this block that was read is one. MRPT's point maps allocate memory for
/// the count in the file before they read a point. It follows the header of the object: a byte with
/// the length of the class name, the name, a byte with the version. MRPT reads each of them
/// separately, so the count can be recognized.
std::optional<std::uint32_t> GzReadStream::pointsIn(const void* piece, std::size_t size) {
  const auto* bytes = static_cast<const unsigned char*>(piece);
  const HeaderPart expected = m_next;
  m_next = HeaderPart::length;
  if (expected == HeaderPart::name && size == m_nameLength &&
      isPointsMap({static_cast<const char*>(piece), size})) {
    m_next = HeaderPart::version;
  } else if (expected == HeaderPart::version && size == 1) {
    m_next = HeaderPart::count;
  } else if (expected == HeaderPart::count && size == 4) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes, sizeof count);
    return count;
  } else if (size == 1 && (bytes[0] & 0x80) != 0) {
    m_nameLength = bytes[0] & 0x7f;
    m_next = HeaderPart::name;
  }
  return std::nullopt;
}

std::size_t GzReadStream::Read(void* buffer, std::size_t count) {
  auto* out = static_cast<unsigned char*>(buffer);
  std::size_t done = 0;
  while (done < count) {
    if (!refill()) {
      m_cutShort = true;
      throw std::runtime_error("the data ends here");
    }
    const std::size_t piece = std::min(count - done, m_end - m_begin);
    std::memcpy(out + done, m_buffer.data() + m_begin, piece);
    m_begin += piece;
    m_position += piece;
    done += piece;
  }
  if (m_follow.count() > 0) return done;
  const auto points = pointsIn(buffer, count);
  if (points && *points > mostLeft() / kPointBytes) {
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
  if (m_follow.count() > 0) return 0;
  // That of zlib is ahead by what it has buffered.
  const auto at = gzdirect(m_file) ? static_cast<z_off_t>(m_position) : gzoffset(m_file);
  return m_fileSize == 0 || at < 0
             ? 1.0
             : std::min(1.0, static_cast<double>(at) / static_cast<double>(m_fileSize));
}

}  // namespace polemcl
