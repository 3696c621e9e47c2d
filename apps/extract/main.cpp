#include "extract/ExtractApp.h"

int main(int argc, char** argv) {
  return polemcl::apps::extractMain(argc, argv);
}
