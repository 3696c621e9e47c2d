/// \file main.cpp
/// \brief The main function of every program. POLEMCL_MAIN is the function that it calls.

namespace polemcl::apps {
int POLEMCL_MAIN(int argc, const char* const* argv);
}

int main(int argc, char** argv) {
  return polemcl::apps::POLEMCL_MAIN(argc, argv);
}
