#pragma once
/// \file Version.h
/// \brief Which polemcl this is.

#include <string>

#include <polemcl/version.h>

namespace polemcl::apps {
/// \brief Version of polemcl, as `--version` prints it first: "1.0.0".
inline const char* version() {
  return POLEMCL_VERSION_TEXT;
}
/// \brief What this library was built from and how, on one line: the commit, with "+" and a hash of
/// the sources when they are not as committed ("sources-" and that hash without git), the compiler,
/// the build type, the options of the compiler. Another identity, possibly other results: it stands
/// in the keys of a batch's tasks and in JSON files and maps.
const char* buildIdentity();
/// \brief What `--version` prints: "pole-map 0.1.0 (build ...)".
inline std::string versionLine(const std::string& program) {
  return program + " " + version() + " (build " + buildIdentity() + ")";
}
}  // namespace polemcl::apps
