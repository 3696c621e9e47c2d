#include "cli/Programs.h"

#include <algorithm>
#include <string>

#include <polemcl/export.h>

namespace polemcl::apps {

// Declared here, as this room stands above those of the programs.
int importMain(int argc, const char* const* argv);
int extractMain(int argc, const char* const* argv);
int mapMain(int argc, const char* const* argv);
int localizeMain(int argc, const char* const* argv);
int evalMain(int argc, const char* const* argv);
int simulateMain(int argc, const char* const* argv);
int batchMain(int argc, const char* const* argv);
int labelsMain(int argc, const char* const* argv);

const std::array<Program, 8>& programs() {
  static constexpr std::array<Program, 8> all = {{{"pole-import", importMain},
                                                  {"pole-extract", extractMain},
                                                  {"pole-map", mapMain},
                                                  {"pole-localize", localizeMain},
                                                  {"pole-eval", evalMain},
                                                  {"pole-simulate", simulateMain},
                                                  {"pole-batch", batchMain},
                                                  {"pole-labels", labelsMain}}};
  return all;
}

}  // namespace polemcl::apps

extern "C" POLEMCL_EXPORT int polemclRunProgram(const char* name, int argc,
                                                const char* const* argv) {
  const auto& all = polemcl::apps::programs();
  const auto found = std::find_if(all.begin(), all.end(), [&](const polemcl::apps::Program& p) {
    return std::string(name) == p.name;
  });
  return found == all.end() ? 2 : found->main(argc, argv);
}
