#include <polemcl/apps/CommandLine.h>
#include <polemcl/apps/MapApp.h>
#include <polemcl/apps/Progress.h>
#include <polemcl/apps/Version.h>
#include <polemcl/core/PoseInterpolation.h>
#include <polemcl/io/PoleMapFile.h>
#include <polemcl/io/PolePositions.h>
#include <polemcl/io/TextFile.h>
#include <polemcl/io/Trajectory.h>
#include <polemcl/mrpt/PoleSequence.h>
#include <polemcl/report/MapScene.h>

#include <algorithm>
#include <iostream>

namespace polemcl::apps {
namespace {

constexpr double maxTruthGap = 2.0;  ///< s, as in evaluateTrajectory()

/// Scans of all inputs with their true poses, in the order of the inputs.
struct Survey {
  std::vector<MappingScan> scans;
  std::vector<StampedPose2D> path;  ///< of the scans, by position in `scans`
};

void addDrive(const MapOptions& options, std::uint32_t drive, const PoleSequence& sequence,
              Survey& survey, MapSummary& summary) {
  const auto &input = options.inputs[drive], &truthFile = options.truths[drive];
  const auto truth = io::planar(io::readTum(truthFile));
  std::size_t matched = 0, unmatched = 0;
  for (const auto& frame : sequence.frames) {
    if (frame.poles_robot.empty() && frame.points == 0) continue;  // blind: neither seen nor missed
    const auto pose = poseAt(truth, frame.time, maxTruthGap);
    if (!pose) {
      ++unmatched;
      continue;
    }
    ++matched;
    survey.scans.push_back({*pose, frame.poles_robot, drive});
    survey.path.push_back({frame.time, *pose});
  }
  if (unmatched > matched)
    throw Error(truthFile.string() + ": has a pose at the time of only " + std::to_string(matched) +
                " of the " + std::to_string(matched + unmatched) + " scans of " + input.string() +
                " (" + io::fixed(sequence.frames.front().time, 3) + " to " +
                io::fixed(sequence.frames.back().time, 3) +
                " s), at least half are needed; is it "
                "the truth of this rawlog?");
  summary.scans += matched;
  summary.unmatched += unmatched;
  summary.emptyScans += sequence.counts.emptyScans;
  summary.invalidPoints += sequence.counts.invalidPoints;
  if (sequence.counts.truncated) ++summary.truncated;
}

std::string noPoles(const MapSummary& summary, const MapOptions& files,
                    const PoleMapOptions& options) {
  const auto& map = summary.map;
  const std::size_t steps = summary.scans - std::min(summary.scans, files.inputs.size());
  const double spacing = steps > 0 ? map.pathLength / static_cast<double>(steps) : 0;
  return "no pole found: " + std::to_string(summary.scans) + " scans " + io::fixed(spacing, 2) +
         " m apart on average; sections of section_length_m = " +
         io::significant(options.sectionLength, 6) + ", " + std::to_string(map.occupiedSections) +
         " of " + std::to_string(map.sections) + " with a scan; " + std::to_string(map.detections) +
         " detections in " + std::to_string(map.clusters) + " places, the best seen in " +
         std::to_string(map.bestCount) +
         " sections of one run, min_count = " + std::to_string(options.minCount) +
         " are needed, max_gap = " + std::to_string(options.maxGap) +
         (map.detections == 0 ? "; see [sensor] and [extraction]" : "; see [map]");
}

std::map<std::string, std::string> facts(const MapOptions& options, const Settings& settings,
                                         const MapSummary& summary) {
  std::string names;
  for (const auto& input : options.inputs)
    names += (names.empty() ? "" : " ") + input.filename().string();
  return {{"program", std::string("pole-map ") + version()},
          {"inputs", names},
          {"scans", std::to_string(summary.scans)},
          {"path_length_m", io::fixed(summary.map.pathLength, 3)},
          {"sections", std::to_string(summary.map.sections)},
          {"occupied_sections", std::to_string(summary.map.occupiedSections)},
          {"detections", std::to_string(summary.map.detections)},
          {"config", settingsText(settings)}};
}

void print(const MapSummary& summary, const MapOptions& options) {
  std::cout << options.output.string() << ": " << summary.map.poles.size() << " poles from "
            << summary.scans << " scans over " << io::fixed(summary.map.pathLength, 1) << " m\n"
            << "sections: " << summary.map.occupiedSections << " of " << summary.map.sections
            << " with a scan; detections " << summary.map.detections << " in "
            << summary.map.clusters << " places\n";
  if (summary.emptyScans > 0)
    std::cout << "scans without a valid point, not used: " << summary.emptyScans << '\n';
  if (summary.unmatched > 0)
    std::cout << "scans without a true pose, not used: " << summary.unmatched << '\n';
  if (summary.invalidPoints > 0)
    std::cout << "invalid points dropped: " << summary.invalidPoints << '\n';
  if (summary.truncated > 0)
    std::cout << "inputs that ended too early: " << summary.truncated
              << "; what could be read was used\n";
}

}  // namespace

void MapOptions::validate() const {
  if (inputs.empty()) throw Error("--input: at least one rawlog is needed");
  if (inputs.size() != truths.size())
    throw Error("--truth: one file per --input is needed, " + std::to_string(inputs.size()) +
                ", not " + std::to_string(truths.size()));
  if (output.extension() != ".polemap")
    throw Error("--output " + output.string() + ": the name must end in .polemap");
}

MapSummary buildMap(const MapOptions& options, const Settings& settings,
                    const std::function<void(std::size_t)>& progress) {
  options.validate();
  SequenceOptions sequence{settings.poleExtraction(), settings.motion, options.allowTruncated};
  // A doubtful detection is worth keeping where others can confirm it.
  if (settings.map.minConfidence > 0)
    sequence.extraction.extraction.native.minConfidence = settings.map.minConfidence;
  MapSummary summary;
  Survey survey;
  for (std::uint32_t i = 0; i < options.inputs.size(); ++i)
    addDrive(options, i, readPoleSequence(options.inputs[i].string(), sequence, progress), survey,
             summary);
  if (survey.scans.empty())
    throw Error(options.inputs.front().string() + ": no usable scan, " +
                std::to_string(summary.emptyScans) + " without a valid point");
  summary.map = buildPoleMap(survey.scans, settings.map);
  if (summary.map.poles.empty()) throw Error(noPoles(summary, options, settings.map));

  if (options.csv) io::writePoleCsv(*options.csv, summary.map.poles);
  if (options.scene) {
    report::MapView view;
    view.title = options.output.filename().string();
    view.poles = summary.map.poles;
    view.truth = survey.path;
    report::saveScene(*report::makeMapScene(view), *options.scene);
  }
  io::writePoleMap(options.output, {summary.map.poles, facts(options, settings, summary)});
  return summary;
}

int mapMain(int argc, const char* const* argv) {
  CommandLine line("pole-map", "Builds a pole map from scans, or poles, at known poses.");
  MapOptions options;
  std::string config;
  auto& cli = line.cli();
  cli.add_option("--config", config, "INI file, see config/")->required();
  cli.add_option("--input", options.inputs, "Rawlogs of scans or poles")->required();
  cli.add_option("--truth", options.truths, "True robot poses, TUM, one file per rawlog")
      ->required();
  cli.add_option("--output", options.output, "Map to write, .polemap")->required();
  cli.add_option("--scene", options.scene, "Also write a .3Dscene of the map");
  cli.add_option("--csv", options.csv, "Also write the poles to this table");
  cli.add_flag("--allow-truncated", options.allowTruncated,
               "Use the readable part of rawlogs that were cut short");
  cli.parse_complete_callback([&] {
    if (options.inputs.size() != options.truths.size())
      throw CLI::ValidationError("--truth", "one file per --input is needed");
  });
  return line.run(argc, argv, [&] {
    const auto settings = loadSettings(config);
    MapSummary summary;
    {
      Progress progress("map", 0, line.quiet());
      summary = buildMap(options, settings, [&](std::size_t done) { progress.update(done); });
    }
    if (!line.quiet()) print(summary, options);
  });
}

}  // namespace polemcl::apps
