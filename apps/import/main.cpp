#include "import/ImportApp.h"

int main(int argc, char** argv) {
  return polemcl::apps::importMain(argc, argv);
}
