#pragma once
/// \file ImportApp.h
/// \brief `pole-import`: datasets to rawlogs.

namespace polemcl::apps {

/// \brief The program; the work is in DatasetImport.h. \return An ExitCode.
int importMain(int argc, const char* const* argv);

}  // namespace polemcl::apps
