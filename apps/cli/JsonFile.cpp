#include "cli/JsonFile.h"

#include <polemcl/core/common/Types.h>
#include "cli/Version.h"
#include "io/file/AtomicFile.h"
#include "io/file/ParsedJson.h"

namespace polemcl::apps {

void writeJson(const std::filesystem::path& file, const nlohmann::ordered_json& given) {
  nlohmann::ordered_json value = given;
  if (value.is_object() && !value.contains("build")) value["build"] = buildIdentity();
  // Names of files need not be UTF-8: replace what is not, rather than fail over a report.
  io::writeFile(file, value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n');
}

nlohmann::ordered_json readJson(const std::filesystem::path& file) {
  try {
    return io::parsedJson<nlohmann::ordered_json>(file);
  } catch (const nlohmann::json::exception& error) {
    throw Error(file.string() + ": " + error.what());
  }
}

}  // namespace polemcl::apps
