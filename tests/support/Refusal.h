#pragma once
/// \file Refusal.h
/// \brief What the library says when it refuses something.

#include <functional>
#include <string>

#include <polemcl/core/common/Types.h>

namespace testing_apps {

/// The message of the Error that the work throws; "no error" without one.
inline std::string messageOf(const std::function<void()>& work) {
  try {
    work();
  } catch (const polemcl::Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace testing_apps
