#pragma once
/// \file ParsedJson.h
/// \brief Reads JSON files that may be damaged or foreign.

#include <filesystem>
#include <string>

#include <polemcl/core/common/Types.h>
#include "io/file/Bytes.h"

namespace polemcl::io {

/// \brief A text in memory. \tparam Kind A kind of nlohmann::basic_json. \param file For errors.
/// \throws Error when it is nested more than 64 deep: such a text would use up the stack.
/// \throws nlohmann::json::exception when it is no JSON.
template <class Kind>
Kind parsedJsonText(const std::string& text, const std::filesystem::path& file) {
  constexpr int kDeepest = 64;
  return Kind::parse(text, [&](int depth, typename Kind::parse_event_t, Kind&) {
    if (depth > kDeepest)
      throw Error(file.string() + ": is nested more than " + std::to_string(kDeepest) + " deep");
    return true;
  });
}

/// \brief The content of a file. \throws as parsedJsonText(), and Error when it cannot be read.
template <class Kind>
Kind parsedJson(const std::filesystem::path& file) {
  return parsedJsonText<Kind>(readBytes(file), file);
}

}  // namespace polemcl::io
