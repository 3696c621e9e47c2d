#pragma once
/// \file ParsedJson.h
/// \brief Reads JSON files that may be damaged or foreign.

#include <filesystem>
#include <string>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "io/file/Bytes.h"

namespace polemcl::io {

/// \brief A text in memory. \tparam Kind A kind of nlohmann::basic_json. \param file For errors.
/// \throws Error when it is nested more than 64 deep: such a text would use up the stack. Also when
///         one object has more than 10000 keys: nlohmann::ordered_json compares each with all
///         others.
/// \throws nlohmann::json::exception when it is no JSON.
template <class Kind>
Kind parsedJsonText(const std::string& text, const std::filesystem::path& file) {
  constexpr int kDeepest = 64;
  constexpr std::size_t kMostKeys = 10000;
  using Event = typename Kind::parse_event_t;
  std::vector<std::size_t> keys;  // of the objects that are open, the innermost last
  return Kind::parse(text, [&](int depth, Event event, Kind&) {
    if (depth > kDeepest)
      throw Error(file.string() + ": is nested more than " + std::to_string(kDeepest) + " deep");
    if (event == Event::object_start) keys.push_back(0);
    if (event == Event::object_end) keys.pop_back();
    if (event == Event::key && ++keys.back() > kMostKeys)
      throw Error(file.string() + ": one of its objects has more than " +
                  std::to_string(kMostKeys) + " keys; at most that many are allowed");
    return true;
  });
}

/// \brief The content of a file. \throws as parsedJsonText(), and Error when it cannot be read.
template <class Kind>
Kind parsedJson(const std::filesystem::path& file) {
  return parsedJsonText<Kind>(readBytes(file), file);
}

}  // namespace polemcl::io
