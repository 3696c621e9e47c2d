#pragma once
/// \file MapApp.h
/// \brief `pole-map build | import | update | diff | convert`.

namespace polemcl::apps {

/// \brief The program. \return An ExitCode.
int mapMain(int argc, const char* const* argv);

}  // namespace polemcl::apps
