#include "labels/LabelsApp.h"

int main(int argc, char** argv) {
  return polemcl::apps::labelsMain(argc, argv);
}
