#include "batch/BatchApp.h"

int main(int argc, char** argv) {
  return polemcl::apps::batchMain(argc, argv);
}
