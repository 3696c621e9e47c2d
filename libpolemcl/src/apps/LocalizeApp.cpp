#include <polemcl/apps/CommandLine.h>
#include <polemcl/apps/JsonFile.h>
#include <polemcl/apps/LocalizeApp.h>
#include <polemcl/apps/LocalizeReport.h>
#include <polemcl/apps/Progress.h>
#include <polemcl/apps/RunFolder.h>
#include <polemcl/apps/Settings.h>
#include <polemcl/core/PoseInterpolation.h>
#include <polemcl/io/Trajectory.h>
#include <polemcl/mrpt/PoleSequence.h>

#include <chrono>
#include <iostream>

namespace polemcl::apps {
namespace {

constexpr double maxTruthGap = 2.0;  ///< s, as in evaluateTrajectory()

Settings settingsOf(const LocalizeJob& job) {
  Settings settings = loadSettings(job.config.string());
  if (job.particles) settings.filter.particles = *job.particles;
  if (job.runs) settings.runs.runs = *job.runs;
  if (job.seed) settings.runs.seed = *job.seed;
  settings.filter.validate();
  settings.runs.validate();
  return settings;
}

/// What the filter needs of the drive, or an error that says what is missing.
void requireUsable(const LocalizeJob& job, const PoleSequence& drive) {
  const std::string file = job.input.string();
  const auto& counts = drive.counts;
  if (drive.frames.empty()) throw Error(file + ": no scan and no poles in it");
  if (counts.unknownMotions > 0)
    throw Error(file + ": " + std::to_string(counts.unknownMotions) + " of " +
                std::to_string(counts.scans) +
                " scans come without odometry, which localization needs; import again with "
                "odometry.txt in the folder or with --odometry-noise");
  if (counts.emptyScans == counts.scans)
    throw Error(file + ": no usable scan, " + std::to_string(counts.emptyScans) +
                " without a valid point");
  if (counts.poles == 0)
    throw Error(file + ": no pole seen in " + std::to_string(counts.scans) +
                " scans; do [sensor] and [extraction] fit the data?");
}

/// The start of the configuration, else the first true pose.
StartOptions startOf(const LocalizeJob& job, const StartOptions& configured,
                     const std::vector<StampedPose2D>& truth, double time) {
  StartOptions start = configured;
  if (start.pose) return start;
  if (!job.truth)
    throw Error(job.config.string() +
                ": no start: set [start] pose = x y yaw_deg, or give --truth");
  start.pose = poseAt(truth, time, maxTruthGap);
  if (!start.pose)
    throw Error(job.truth->string() + ": has no pose at the time of the first scan, " +
                std::to_string(time) + " s; set [start] pose = x y yaw_deg");
  return start;
}

void write(const LocalizeFacts& facts, const LocalizeResult& result, const Settings& settings,
           double extractionSeconds) {
  RunFolder folder(facts.job.output);
  nlohmann::ordered_json timings;
  timings["extraction_s"] = extractionSeconds;
  for (std::size_t i = 0; i < result.runs.size(); ++i) {
    const FilterRun& run = result.runs[i];
    io::writeTum(folder.staged(runName(i) + ".tum"), run.trajectory);
    if (!result.errors.empty())
      writeErrorsCsv(folder.staged(runName(i) + "_errors.csv"), run, result.errors[i]);
    timings["filter_s"].push_back(run.seconds);
  }
  saveSettings(settings, folder.staged("config.ini").string());
  writeJson(folder.staged("timings.json"), timings);
  writeJson(folder.staged("summary.json"), makeSummary(facts, result));
  folder.commit();
}

}  // namespace

LocalizeResult localize(const LocalizeJob& job) {
  LocalizeFacts facts;
  facts.job = job;
  Settings settings = settingsOf(job);
  std::vector<StampedPose2D> truth;
  if (job.truth) truth = io::planar(io::readTum(*job.truth));
  auto map = std::make_shared<CPoleMap>();
  map->likelihoodOptions = settings.likelihood;  // first: loading prepares the index for its gate
  map->loadFromPoleMapFile(job.map.string());
  if (map->isEmpty()) throw Error(job.map.string() + ": the map has no poles");

  const auto begin = std::chrono::steady_clock::now();
  const SequenceOptions options{settings.poleExtraction(), settings.motion, job.allowTruncated};
  PoleSequence drive;
  {
    Progress progress("extract", 0, job.quiet);
    drive = readPoleSequence(job.input.string(), options,
                             [&](std::size_t done) { progress.update(done); });
  }
  requireUsable(job, drive);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  facts.start = settings.start = startOf(job, settings.start, truth, drive.frames.front().time);
  facts.filter = settings.filter;
  facts.runs = settings.runs;
  facts.counts = drive.counts;
  facts.mapPoles = map->poles().size();
  LocalizeResult result;
  {
    const std::size_t steps = drive.frames.size() * static_cast<std::size_t>(settings.runs.runs);
    Progress progress("localize", steps, job.quiet);
    result.runs = runFilters(map, drive.frames, settings.filter, settings.start, settings.runs,
                             [&](std::size_t done) { progress.update(done); });
  }
  if (job.truth)
    for (const FilterRun& run : result.runs)
      result.errors.push_back(evaluateTrajectory(truth, run.trajectory, Sampling::perPose));
  write(facts, result, settings, seconds);
  if (!job.quiet) printTable(std::cout, facts, result);
  return result;
}

int localizeMain(int argc, const char* const* argv) {
  CommandLine line("pole-localize", "Plays a rawlog against a pole map.");
  LocalizeJob job;
  auto& cli = line.cli();
  cli.add_option("--config", job.config, "INI file, see config/")->required();
  cli.add_option("--input", job.input, "Rawlog of scans or poles, with odometry")->required();
  cli.add_option("--map", job.map, "Pole map, .polemap")->required();
  cli.add_option("--output", job.output, "Folder for the results")->required();
  cli.add_option("--truth", job.truth, "True robot poses, TUM: start and errors");
  cli.add_option("--runs", job.runs, "How often to localize; run i has seed + i");
  cli.add_option("--seed", job.seed, "Of the first run");
  cli.add_option("--particles", job.particles, "Instead of the configuration's");
  cli.add_flag("--allow-truncated", job.allowTruncated,
               "Use the readable part of a rawlog that was cut short");
  return line.run(argc, argv, [&] {
    job.quiet = line.quiet();
    localize(job);
  });
}

}  // namespace polemcl::apps
