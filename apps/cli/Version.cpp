#include "cli/Version.h"

namespace polemcl::apps {
const char* version() {
  return POLEMCL_VERSION;
}
}  // namespace polemcl::apps
