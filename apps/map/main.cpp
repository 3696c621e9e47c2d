#include "map/MapApp.h"

int main(int argc, char** argv) {
  return polemcl::apps::mapMain(argc, argv);
}
