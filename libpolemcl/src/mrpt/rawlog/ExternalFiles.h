#pragma once
/// \file ExternalFiles.h
/// \brief Where the external files of a rawlog are. Private to the library.

#include <string>

namespace polemcl {

/// \brief Tells MRPT. Relative names of external files are meant from the folder MRPT's tools put
/// them in, if there is one, else from the rawlog's own.
void findExternals(const std::string& rawlog);

}  // namespace polemcl
