/// \file main.cpp
/// \brief All programs are one file: the name by which it is called tells which one runs.

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <optional>

#include "batch/BatchApp.h"
#include "cli/Messages.h"
#include "eval/EvalApp.h"
#include "extract/ExtractApp.h"
#include "import/ImportApp.h"
#include "labels/LabelsApp.h"
#include "localize/LocalizeApp.h"
#include "map/MapApp.h"
#include "simulate/SimulateApp.h"

namespace {

/// An output must not get the number of a standard stream that is closed: prints would go into it.
void openStandardStreams() {
  for (const int descriptor : {0, 1, 2})
    if (fcntl(descriptor, F_GETFD) < 0) open("/dev/null", O_RDWR);  // takes the lowest free number
}

}  // namespace

int main(int argc, char** argv) {
  using namespace polemcl::apps;
  openStandardStreams();
  static constexpr struct {
    const char* name;
    int (*main)(int argc, const char* const* argv);
  } programs[] = {{"pole-import", importMain}, {"pole-extract", extractMain},
                  {"pole-map", mapMain},       {"pole-localize", localizeMain},
                  {"pole-eval", evalMain},     {"pole-simulate", simulateMain},
                  {"pole-batch", batchMain},   {"pole-labels", labelsMain}};
  endUncaughtInOneLine(argv[0]);
  std::optional<PrintableOutput> forTerminal;
  if (::isatty(STDOUT_FILENO) == 1) forTerminal.emplace(std::cout);
  const auto name = std::filesystem::path(argv[0]).filename();
  for (const auto& program : programs)
    if (name == program.name) return program.main(argc, argv);
  std::cerr << "polemcl: holds all programs; call it by the name of one:";
  for (const auto& program : programs) std::cerr << ' ' << program.name;
  std::cerr << '\n';
  return 2;
}
