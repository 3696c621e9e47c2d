/// \file MrptTruth.cpp
/// \brief `pole-eval mrpt-truth`: true poses as MRPT's pf-localization reads them. It takes the
/// first column for indices if the first two times are whole numbers: poses at the start with such
/// times are left out.

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>

#include "cli/Outputs.h"
#include "eval/EvalApp.h"
#include "io/data/Trajectory.h"
#include "io/file/AtomicFile.h"

namespace polemcl::apps {
namespace {

void writeMrptTruth(const std::filesystem::path& tum, const std::filesystem::path& output) {
  const auto poses = io::readPlanarTum(tum);
  const auto isWhole = [](const StampedPose2D& pose) { return pose.time == std::floor(pose.time); };
  const auto first = std::adjacent_find(
      poses.begin(), poses.end(),
      [&](const auto& pose, const auto& next) { return !isWhole(pose) && !isWhole(next); });
  if (first == poses.end())
    throw Error(tum.string() +
                ": two successive times that are no whole seconds are needed: "
                "pf-localization takes whole ones for indices");
  std::ostringstream rows;
  rows.precision(9);
  rows << std::fixed;
  for (auto pose = first; pose != poses.end(); ++pose)
    rows << pose->time << ' ' << pose->pose.x << ' ' << pose->pose.y << ' ' << pose->pose.yaw
         << '\n';
  io::writeFile(output, rows.str());
}

}  // namespace

Subcommand mrptTruthCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand(
      "mrpt-truth", "Writes true poses as MRPT's pf-localization reads them: time x y yaw");
  const auto truth = std::make_shared<std::filesystem::path>();
  const auto output = std::make_shared<std::filesystem::path>();
  addFile(cli, "--truth", *truth, "True robot poses, TUM")->required();
  addOutput(cli, "--output", *output, "File to write")->required();
  return {&cli, [truth, output](bool) {
            writeMrptTruth(*truth, *output);
            return output->string() + ": true poses for pf-localization\n";
          }};
}

}  // namespace polemcl::apps
