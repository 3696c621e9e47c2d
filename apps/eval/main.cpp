#include "eval/EvalApp.h"

int main(int argc, char** argv) {
  return polemcl::apps::evalMain(argc, argv);
}
