#pragma once
/// \file PointCountGuard.h
/// \brief Looks over MRPT's shoulder while it reads maps of points.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace polemcl {

/// \brief MRPT's maps of points take memory for the count in the file before they read a point. The
/// count stands right behind the header of the object (a byte with the length of the class's name,
/// the name, a byte with the version), and MRPT reads each of these by itself: so it is known here.
class PointCountGuard {
 public:
  /// \brief Is told of every piece that was read.
  /// \return The count of points, when this piece is one.
  std::optional<std::uint32_t> see(const void* piece, std::size_t size);
  /// A point has at least x, y and z.
  static constexpr std::uint64_t pointBytes = 12;

 private:
  enum class Next { length, name, version, count };
  Next m_next = Next::length;
  std::size_t m_nameLength = 0;
};

}  // namespace polemcl
