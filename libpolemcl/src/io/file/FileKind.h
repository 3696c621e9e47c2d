#pragma once
/// \file FileKind.h
/// \brief What the ending of a file says it is, for messages about files in the wrong place.

#include <filesystem>
#include <string>

namespace polemcl::io {

/// \brief Such as "it is a rawlog, " for `x.rawlog`; empty for an ending that is not known, or
/// that is the one expected.
/// \param expected With its dot.
std::string otherKind(const std::filesystem::path& file, const std::string& expected);

}  // namespace polemcl::io
