#pragma once
/// \brief Measures the peak memory of a piece of work. Replaces `new` and `delete` of a test
/// program and of the library it loads: include it in one source file of a program only. Under the
/// thread sanitizer, whose library has these operators, nothing is measured.

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace polemcl::tests {

inline std::atomic<std::size_t> memoryLive{0}, memoryPeak{0};

inline void* takeMemory(std::size_t size) {
  void* const memory = std::malloc(size);
  if (!memory) throw std::bad_alloc();
  const std::size_t live = memoryLive += ::malloc_usable_size(memory);
  std::size_t peak = memoryPeak;
  while (live > peak && !memoryPeak.compare_exchange_weak(peak, live)) {
  }
  return memory;
}

inline void giveMemory(void* memory) {
  if (memory) memoryLive -= ::malloc_usable_size(memory);
  std::free(memory);
}

/// \brief Peak number of bytes that `work` allocates in addition to those in use before it.
template <class Work>
std::size_t memoryTakenBy(Work work) {
  const std::size_t before = memoryLive;
  memoryPeak = before;
  work();
  return memoryPeak - before;
}

}  // namespace polemcl::tests

#ifndef __SANITIZE_THREAD__
void* operator new(std::size_t size) {
  return polemcl::tests::takeMemory(size);
}
void* operator new[](std::size_t size) {
  return polemcl::tests::takeMemory(size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return polemcl::tests::takeMemory(size);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return polemcl::tests::takeMemory(size);
}
void operator delete(void* memory) noexcept {
  polemcl::tests::giveMemory(memory);
}
void operator delete[](void* memory) noexcept {
  polemcl::tests::giveMemory(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  polemcl::tests::giveMemory(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  polemcl::tests::giveMemory(memory);
}
#endif
