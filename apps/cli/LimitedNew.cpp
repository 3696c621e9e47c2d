/// \file LimitedNew.cpp
/// \brief Replaces `new` and `aligned_alloc` in the programs, so that AllocationLimit can bound
/// them. Not with sanitizers, which bring their own.

#include <algorithm>
#include <cstdlib>
#include <new>

#include "mrpt/common/AllocationLimit.h"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

PolemclAllocationLimit* polemclAllocationLimit() {
  static thread_local PolemclAllocationLimit limit;
  return &limit;
}

namespace {

void requireAllowed(std::size_t size) {
  PolemclAllocationLimit& limit = *polemclAllocationLimit();
  limit.taken = size == limit.piece ? limit.taken + size : size;
  limit.piece = size;
  if (limit.taken <= limit.most) return;
  limit.taken = 0;
  limit.reached = true;
  throw std::bad_alloc();
}

void* alignedMemory(std::size_t alignment, std::size_t size) {
  requireAllowed(size);
  void* memory = nullptr;
  if (::posix_memalign(&memory, std::max(alignment, sizeof(void*)), size) != 0)
    throw std::bad_alloc();
  return memory;
}

}  // namespace

// The other forms of new and delete call these.
void* operator new(std::size_t size) {
  requireAllowed(size);
  if (void* const memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}

// That of libstdc++ calls aligned_alloc before GCC 14, posix_memalign since.
void* operator new(std::size_t size, std::align_val_t alignment) {
  return alignedMemory(static_cast<std::size_t>(alignment), size);
}

void operator delete(void* memory) noexcept {
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}

void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

// MRPT's point maps, scans and images take their memory here, and write to it even if they got a
// null pointer. Its own name, as the one of the C library must not throw.
extern "C" [[gnu::visibility("default")]] void* polemclAlignedAlloc(
    std::size_t alignment, std::size_t size) __asm__("aligned_alloc");
void* polemclAlignedAlloc(std::size_t alignment, std::size_t size) {
  return alignedMemory(alignment, size);
}

#endif
