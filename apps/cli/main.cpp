/// \file main.cpp
/// \brief The main function of every program. POLEMCL_MAIN is the function that it calls.

#include "cli/Failure.h"

namespace polemcl::apps {
int POLEMCL_MAIN(int argc, const char* const* argv);
}

int main(int argc, char** argv) {
  polemcl::apps::endUncaughtInOneLine(argv[0]);
  return polemcl::apps::POLEMCL_MAIN(argc, argv);
}
