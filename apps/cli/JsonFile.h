#pragma once
/// \file JsonFile.h
/// \brief Results for scripts: JSON files, keys in the order they were set.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

/// Values that may be missing: `null` then.
template <class T>
struct nlohmann::adl_serializer<std::optional<T>> {
  template <class Json>
  static void to_json(Json& json, const std::optional<T>& value) {
    json = value ? Json(*value) : Json();
  }
};

namespace polemcl::apps {

using Json = nlohmann::ordered_json;

/// \brief Writes the value, indented by two, atomically: the file is complete or as it was before.
/// Numbers keep all their digits; what is not finite becomes `null`.
/// \throws Error when it cannot be written.
void writeJson(const std::filesystem::path& file, const Json& value);

/// \throws Error naming the file when it cannot be read or holds no JSON.
Json readJson(const std::filesystem::path& file);

}  // namespace polemcl::apps
