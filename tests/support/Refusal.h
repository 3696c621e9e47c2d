#pragma once
// Expectations of refusals: an Error with one line that says certain things.

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "support/ExpectHas.h"

namespace polemcl::tests {

/// The message of the Error that the work throws; "no error" without one.
inline std::string messageOf(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// Whether a message is one line that has all of these parts.
inline testing::AssertionResult says(const std::string& message,
                                     const std::vector<std::string>& parts) {
  if (message == "no error") return testing::AssertionFailure() << "nothing was refused";
  for (const std::string& part : parts)
    if (message.find(part) == std::string::npos)
      return testing::AssertionFailure() << "'" << part << "' is not in: " << message;
  if (message.find('\n') != std::string::npos)
    return testing::AssertionFailure() << "more than one line: " << message;
  return testing::AssertionSuccess();
}

}  // namespace polemcl::tests

/// The statement must throw an Error whose one line has all of the texts that follow.
#define EXPECT_REFUSED(statement, ...) \
  EXPECT_TRUE(::polemcl::tests::says(  \
      ::polemcl::tests::messageOf([&] { static_cast<void>(statement); }), {__VA_ARGS__}))

namespace testing_apps {
using polemcl::tests::messageOf;
}
