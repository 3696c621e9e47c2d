#pragma once
/// \file AllocationLimit.h
/// \brief Bounds what `new` gives while a file is read by code that trusts its counts.

#include <cstddef>

namespace polemcl {

/// \brief While it exists, `new` and `aligned_alloc` throw std::bad_alloc where this thread asks
/// for more bytes, at a time or one after the other in pieces of the same size. MRPT's classes take
/// memory for a count or a length in a file before they read what it counts, in a std::vector or in
/// the pieces of a std::deque. Errors take memory in pieces of other sizes.
///
/// Only a program can replace them: ours do (apps/cli/LimitedNew.cpp). In others, such as Python
/// or MRPT's, and in builds with sanitizers, nothing is limited.
class AllocationLimit {
 public:
  explicit AllocationLimit(std::size_t most);
  ~AllocationLimit();
  AllocationLimit(const AllocationLimit&) = delete;
  AllocationLimit& operator=(const AllocationLimit&) = delete;
  /// \brief True once `new` has refused something because of it.
  bool reached() const;
};

}  // namespace polemcl

/// \brief The limit of one thread, as the program that replaces `new` keeps it.
struct PolemclAllocationLimit {
  std::size_t most = -1;  ///< bytes
  std::size_t piece = 0;  ///< bytes that it asked for last
  std::size_t taken = 0;  ///< bytes of the last pieces of this size
  bool reached = false;
};
/// \brief That of the calling thread. Null where the program does not replace `new`.
extern "C" [[gnu::weak, gnu::visibility("default")]] PolemclAllocationLimit*
polemclAllocationLimit();
