#include "simulate/SimulateApp.h"

int main(int argc, char** argv) {
  return polemcl::apps::simulateMain(argc, argv);
}
