#pragma once
/// \file AllocationLimit.h
/// \brief Bounds what `new` gives while a file is read by code that trusts its counts.

#include <cstddef>

namespace polemcl {

/// \brief While it exists, `new` and `aligned_alloc` give this thread that many bytes in all, then
/// throw std::bad_alloc. What is given back does not count, nor what the handling of an exception
/// takes. MRPT's classes take memory for a count or a length in a file before they read what it
/// counts, some of them (a std::deque) in small pieces.
///
/// Only a program can replace them: ours do (apps/cli/LimitedNew.cpp). In others, such as Python
/// or MRPT's, and in builds with sanitizers, nothing is limited.
class AllocationLimit {
 public:
  explicit AllocationLimit(std::size_t bytes);
  ~AllocationLimit();
  AllocationLimit(const AllocationLimit&) = delete;
  AllocationLimit& operator=(const AllocationLimit&) = delete;
  /// \brief Whether `new` has refused something because of the last one of this thread.
  static bool reached();
};

}  // namespace polemcl

/// \brief The limit of one thread, as the program that replaces `new` keeps it.
struct PolemclAllocationLimit {
  std::size_t left = -1;  ///< bytes that it may still ask for
  bool reached = false;
};
/// \brief That of the calling thread. Null where the program does not replace `new`.
extern "C" [[gnu::weak, gnu::visibility("default")]] PolemclAllocationLimit*
polemclAllocationLimit();
