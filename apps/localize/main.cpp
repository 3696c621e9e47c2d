#include "localize/LocalizeApp.h"

int main(int argc, char** argv) {
  return polemcl::apps::localizeMain(argc, argv);
}
