#pragma once
/// \file Version.h

namespace polemcl::apps {
/// \brief Version of polemcl, as `--version` prints it.
const char* version();
}  // namespace polemcl::apps
