#include "cli/JsonFile.h"

#include "cli/Version.h"
#include "io/file/AtomicFile.h"

namespace polemcl::apps {

void writeJson(const std::filesystem::path& file, const nlohmann::ordered_json& given) {
  nlohmann::ordered_json value = given;
  if (value.is_object() && !value.contains("build")) value["build"] = buildIdentity();
  io::AtomicFile out(file);
  // Names of files need not be UTF-8: replace what is not, rather than fail over a report.
  out.stream() << value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  out.commit();
}

}  // namespace polemcl::apps
