// The main of each program. CMake names the function that POLEMCL_MAIN stands for.
namespace polemcl::apps {
int POLEMCL_MAIN(int argc, const char* const* argv);
}

int main(int argc, char** argv) {
  return polemcl::apps::POLEMCL_MAIN(argc, argv);
}
