#pragma once
/// \file PointCountGuard.h
/// \brief Detects the counts of point maps while MRPT reads them.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace polemcl {

/// \brief MRPT's point maps allocate memory for the count in the file before they read a point. The
/// count follows the header of the object: a byte with the length of the class name, the name, a
/// byte with the version. MRPT reads each of them separately, so this class can recognize the
/// count.
class PointCountGuard {
 public:
  /// \brief Call it for every block that was read.
  /// \return The count of points, if this block is one.
  std::optional<std::uint32_t> see(const void* piece, std::size_t size);
  /// A point has at least x, y and z.
  static constexpr std::uint64_t kPointBytes = 12;

 private:
  enum class Next { length, name, version, count };
  Next m_next = Next::length;
  std::size_t m_nameLength = 0;
};

}  // namespace polemcl
