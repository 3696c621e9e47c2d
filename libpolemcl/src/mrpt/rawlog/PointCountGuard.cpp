#include "mrpt/rawlog/PointCountGuard.h"

#include <cstring>
#include <string_view>

namespace polemcl {

namespace {

/// E.g. "mrpt::maps::CPointsMapXYZI", or "CSimplePointsMap" of old files.
bool isPointsMap(std::string_view name) {
  return name.find("PointsMap") != std::string_view::npos;
}

}  // namespace

std::optional<std::uint32_t> PointCountGuard::see(const void* piece, std::size_t size) {
  const auto* bytes = static_cast<const unsigned char*>(piece);
  const Next expected = m_next;
  m_next = Next::length;
  if (expected == Next::name && size == m_nameLength &&
      isPointsMap({static_cast<const char*>(piece), size})) {
    m_next = Next::version;
  } else if (expected == Next::version && size == 1) {
    m_next = Next::count;
  } else if (expected == Next::count && size == 4) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes, sizeof count);
    return count;
  } else if (size == 1 && (bytes[0] & 0x80) != 0) {
    m_nameLength = bytes[0] & 0x7f;
    m_next = Next::name;
  }
  return std::nullopt;
}

}  // namespace polemcl
