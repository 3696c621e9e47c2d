#pragma once
/// \file ExternalFiles.h
/// \brief Location of a rawlog's external files. Private to the library.

#include <string>

namespace polemcl {

/// \brief Sets the base folder of relative names in MRPT: the folder that MRPT's tools use
/// (`<rawlog>_Images`) if it exists, otherwise the folder of the rawlog.
void findExternals(const std::string& rawlog);

}  // namespace polemcl
