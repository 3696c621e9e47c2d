#pragma once
/// \file Lock.h
/// \brief Work without Python's lock, and threads that are busy while Python ends.

#include <cxxabi.h>
#include <pybind11/pybind11.h>
#include <unistd.h>

#include <exception>
#include <mutex>
#include <optional>
#include <type_traits>
#include <utility>

namespace polemcl::apps::python {

/// \brief Does work that may wait for Python's lock. While Python ends, it ends the thread that
/// waits, and the objects of all its calls would go without the lock. So the thread waits until the
/// process is gone, as from Python 3.14 on. `work` must not hold Python objects where it waits.
template <class Work>
auto untilPythonEnds(const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const abi::__forced_unwind&) {
    while (true) ::pause();
  }
}

/// \brief Does work without Python's lock. `work` must not touch Python.
template <class Work>
auto withoutLock(const Work& work) -> decltype(work()) {
  constexpr bool isVoid = std::is_void_v<decltype(work())>;
  std::conditional_t<isVoid, char, std::optional<decltype(work())>> result{};
  std::exception_ptr failure;
  PyThreadState* const state = PyEval_SaveThread();
  try {
    if constexpr (isVoid)
      work();
    else
      result.emplace(work());
  } catch (...) {
    failure = std::current_exception();
  }
  untilPythonEnds([&] { PyEval_RestoreThread(state); });
  if (failure) std::rethrow_exception(failure);
  if constexpr (!isVoid) return std::move(*result);
}

/// \brief The same, alone on an object.
template <class Work>
auto alone(std::mutex& object, const Work& work) {
  return withoutLock([&] {
    const std::lock_guard<std::mutex> lock(object);
    return work();
  });
}

}  // namespace polemcl::apps::python
