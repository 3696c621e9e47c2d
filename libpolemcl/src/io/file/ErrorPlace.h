#pragma once
/// \file ErrorPlace.h
/// \brief Errors of a piece of work, with the place where they come from.

#include <string>

#include <polemcl/core/common/Types.h>

namespace polemcl::io {

/// \brief What `work` returns. \throws Error as `work` does, with `where` before its message.
template <class Work>
decltype(auto) located(const std::string& where, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw Error(where + error.what());
  }
}

/// \brief The message of the Error that `work` throws; empty when it throws none.
template <class Work>
std::string problemOf(const Work& work) {
  try {
    work();
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace polemcl::io
