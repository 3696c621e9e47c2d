#include "labels/LabelsApp.h"

#include <iostream>

#include "cli/CommandLine.h"
#include "cli/Outputs.h"
#include "cli/Progress.h"
#include "cli/Version.h"
#include "io/dataset/KittiOdometry.h"
#include "io/dataset/LabelledScans.h"
#include "io/dataset/ScanFiles.h"
#include "io/file/AtomicFile.h"
#include "io/map/PoleMapFile.h"
#include "io/map/PoleTables.h"

namespace polemcl::apps {
namespace {

bool isMap(const std::filesystem::path& output) {
  const auto ending = output.extension();
  if (ending != ".polemap" && ending != ".csv")
    throw Error("--output " + output.string() + ": the name must end in .polemap or .csv");
  return ending == ".polemap";
}

void write(const LabelsOptions& options, const LabelsSummary& summary,
           const std::vector<MapPole>& poles) {
  if (!isMap(options.output)) return io::writePoleCsv(options.output, poles);
  io::PoleMapData map;
  map.poles = poles;
  map.info = {{"program", std::string("pole-labels ") + version()},
              {"build", buildIdentity()},
              {"inputs", io::folderNamed(options.input).filename()},
              {"scans", std::to_string(summary.scans)},
              {"points", std::to_string(summary.points)}};
  io::writePoleMap(options.output, map);
}

void addLabelsOptions(CLI::App& cli, LabelsOptions& options) {
  LabelMapOptions& labels = options.labels;
  addFolder(cli, "--input", options.input, "Folder sequences/NN of SemanticKITTI")->required();
  addOutput(cli, "--output", options.output, "Poles to write, .polemap or .csv")->required();
  const auto number = [&](const char* name, auto& value, const char* what) {
    cli.add_option(name, value, what)->capture_default_str();
  };
  number("--stems", labels.stems, "Classes of trunks and poles, as SemanticKITTI numbers them");
  number("--signs", labels.signs, "Classes of signs and lights on poles, in the same way");
  number("--max-range", labels.maxRange, "Range of the points used, m");
  number("--max-width", labels.maxWidth, "Largest width of one pole, m");
  number("--min-height", labels.minHeight,
         "Least height of a pole, from its lowest to its highest point, m");
  number("--min-scans", labels.minScans, "Least number of scans that see a pole");
  number("--min-points", labels.minPoints, "Least number of points of a pole");
}

const Guides kLabelsGuides{
    {"",
     {{"pole-labels --input dataset/sequences/00 --output 00-truth.polemap"},
      "Score a map with it: pole-eval map --truth 00-truth.polemap --map 00.polemap "
      "--one-to-one."}},
};

}  // namespace

LabelsSummary mapLabels(const LabelsOptions& options,
                        const std::function<void(std::size_t, std::size_t)>& progress) {
  isMap(options.output);
  const io::AtomicFile early(options.output);  // throws before the long work, not after it
  LabelMapBuilder builder(options.labels);
  const auto sequence = io::readKittiOdometry(options.input, Eigen::Isometry3d::Identity());
  for (const io::ScanEntry& scan : sequence.scans) {
    if (!scan.T_map_robot)
      throw Error(options.input.string() +
                  ": no poses; poses.txt in it, or ../../poses/NN.txt, is needed");
    const auto labelled = io::readLabelledCloud(scan.cloud, io::labelFile(scan.cloud));
    builder.add(*scan.T_map_robot, labelled.cloud.view(), labelled.labels);
    if (progress) progress(builder.scans(), sequence.scans.size());
  }
  const auto poles = builder.poles();
  if (poles.empty())
    throw Error(options.input.string() + ": no pole found; " + std::to_string(builder.points()) +
                " points of its classes in " + std::to_string(builder.scans()) +
                " scans; are these SemanticKITTI's labels?");
  const LabelsSummary summary{builder.scans(), builder.points(), poles.size()};
  write(options, summary, poles);
  return summary;
}

int labelsMain(int argc, const char* const* argv) {
  CommandLine line("pole-labels",
                   "Builds a map of the true poles from the labels and poses of SemanticKITTI.",
                   kLabelsGuides);
  LabelsOptions options;
  addLabelsOptions(line.cli(), options);
  return line.run(argc, argv, [&] {
    const auto summary = mapLabels(options, Progress("label", 0, line.quiet()).updates());
    if (!line.quiet())
      std::cout << options.output.string() << ": " << summary.poles << " poles from "
                << summary.points << " points in " << summary.scans << " scans\n";
  });
}

}  // namespace polemcl::apps
