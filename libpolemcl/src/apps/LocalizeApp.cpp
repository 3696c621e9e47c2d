#include <polemcl/apps/CommandLine.h>
#include <polemcl/apps/JsonFile.h>
#include <polemcl/apps/LocalizeApp.h>
#include <polemcl/apps/LocalizeReport.h>
#include <polemcl/apps/Progress.h>
#include <polemcl/apps/RunFolder.h>
#include <polemcl/apps/RunView.h>
#include <polemcl/apps/Settings.h>
#include <polemcl/apps/TrialDrive.h>
#include <polemcl/core/PoseInterpolation.h>
#include <polemcl/io/Trajectory.h>
#include <polemcl/mrpt/PoleSequence.h>

#include <chrono>
#include <iostream>

namespace polemcl::apps {

namespace {

constexpr double maxTruthGap = 2.0;  // s, as in evaluateTrajectory()

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// X,Y,YAW_DEG,RADIUS,HEADING_DEG of the command line.
void setStart(StartOptions& start, const std::vector<double>& numbers) {
  constexpr double degree = M_PI / 180;
  start.anywhere = false;
  start.pose = Pose2D{numbers[0], numbers[1], wrapAngle(numbers[2] * degree)};
  start.radius = numbers[3];
  start.heading = numbers[4] * degree;
}

void setView(report::ViewOptions& view, const LocalizeJob& job) {
  if (job.live) view.live = true;
  if (job.hold) view.live = view.hold = true;
  if (job.rate) view.rate = *job.rate;
  if (job.scenes) view.scenes = *job.scenes;
  if (job.frames) view.frames = *job.frames;
  if (job.frameEvery) view.frameEvery = *job.frameEvery;
  view.validate();
}

Settings effectiveSettings(const LocalizeJob& job) {
  Settings settings = loadSettings(job.config.string(), job.set);
  if (job.runs) settings.runs.runs = *job.runs;
  if (job.seed) settings.runs.seed = *job.seed;
  if (job.particles) settings.localization.filter.particles = *job.particles;
  if (job.anywhere) settings.start.anywhere = true;
  if (!job.start.empty()) setStart(settings.start, job.start);
  setView(settings.view, job);
  settings.runs.validate();
  settings.localization.validate();
  settings.start.validate();
  return settings;
}

PoleSequence readPoles(const LocalizeJob& job, const Settings& settings) {
  SequenceOptions options;
  options.extraction = settings.poleExtraction();
  options.motion = settings.motion;
  options.allowTruncated = job.allowTruncated;
  Progress progress("read", 0, job.quiet);
  return readPoleSequence(job.input.string(), options, [&](std::size_t done, std::size_t total) {
    progress.update(done, total);
  });
}

void requireUsable(const std::string& input, const PoleSequence& sequence) {
  const auto& counts = sequence.counts;
  if (sequence.frames.empty())
    throw Error(input + ": holds no scan and no poles; import or extract them first");
  for (std::size_t i = 1; i < sequence.frames.size(); ++i)
    if (!sequence.frames[i].motion)
      throw Error(input + ": no odometry before scan " + std::to_string(i) + " (" +
                  std::to_string(counts.unknownMotions) + " of " + std::to_string(counts.scans) +
                  " scans lack it): the filter needs it; import with an odometry file or with "
                  "--odometry-noise");
  if (counts.emptyScans == counts.scans)
    throw Error(input + ": no usable scan: none of " + std::to_string(counts.scans) +
                " has a valid point");
  if (counts.poles == 0)
    throw Error(input + ": no pole in any of " + std::to_string(counts.scans) + " scans (" +
                std::to_string(counts.points) + " valid points, " +
                std::to_string(counts.emptyScans) +
                " empty scans): check [sensor] and [extraction]");
}

/// Less than half of the scans covered is an error before the filter runs, not after.
void requireCoverage(const std::filesystem::path& file, const std::vector<StampedPose2D>& truth,
                     const std::vector<PoleFrame>& frames) {
  std::size_t covered = 0;
  for (const auto& frame : frames) covered += poseAt(truth, frame.time, maxTruthGap).has_value();
  if (2 * covered < frames.size())
    throw Error(file.string() + ": the truth covers " + std::to_string(covered) + " of " +
                std::to_string(frames.size()) + " scans, at least half are needed: does it " +
                "belong to this rawlog?");
}

StartOptions startFrom(const StartOptions& configured, const LocalizeJob& job,
                       const std::vector<StampedPose2D>& truth,
                       const std::vector<PoleFrame>& frames) {
  StartOptions start = configured;
  if (start.anywhere || start.pose) return start;
  if (!job.truth)
    throw Error("no start pose: set position_m and yaw_deg in [start] of " + job.config.string() +
                ", or give --start, --global or --truth");
  start.pose = poseAt(truth, frames.front().time, maxTruthGap);
  if (!start.pose)
    throw Error(job.truth->string() + ": the truth does not reach the first scan, at " +
                std::to_string(frames.front().time) + " s: set position_m and yaw_deg in [start]");
  return start;
}

std::vector<FilterRun> runAll(const LocalizeFacts& facts, const LocalizationMap& map,
                              const std::vector<PoleFrame>& frames, RunView& view) {
  Progress progress("localize", frames.size() * facts.runs.runs, facts.job.quiet);
  RunWatch watch;
  watch.observer = view.observer();
  watch.progress = [&](std::size_t done) { progress.update(done); };
  return runFilters(map, frames, facts.localization, facts.start, facts.runs, watch);
}

/// A run that never knew where it was has no errors, which is not the same as none.
std::optional<TrajectoryErrors> judge(const FilterRun& run,
                                      const std::vector<StampedPose2D>& truth) {
  const auto trajectory = run.trajectory();
  if (trajectory.empty()) return std::nullopt;
  return evaluateTrajectory(truth, trajectory, Sampling::perPose, maxTruthGap);
}

void writeTimings(const std::filesystem::path& file, double reading,
                  const std::vector<FilterRun>& runs) {
  nlohmann::ordered_json json;
  json["read_and_extract_s"] = reading;
  for (const auto& run : runs) json["filter_s"].push_back(run.seconds);
  writeJson(file, json);
}

void writeResults(RunFolder& folder, const LocalizeFacts& facts, const Settings& settings,
                  const LocalizeResult& result, double reading) {
  for (std::size_t i = 0; i < result.runs.size(); ++i) {
    const FilterRun& run = result.runs[i];
    io::writeTum(folder.staged(runName(i) + ".tum"), run.trajectory());
    writeCovarianceCsv(folder.staged(runName(i) + "_cov.csv"), run);
    writeHealthCsv(folder.staged(runName(i) + "_health.csv"), run);
    if (!result.errors.empty() && result.errors[i])
      writeErrorsCsv(folder.staged(runName(i) + "_errors.csv"), run, *result.errors[i]);
  }
  saveSettings(settings, folder.staged("config.ini").string());
  writeTimings(folder.staged("timings.json"), reading, result.runs);
  writeJson(folder.staged("summary.json"), makeSummary(facts, result));
  folder.commit();
}

}  // namespace

LocalizeResult localize(const LocalizeJob& job) {
  const Settings settings = effectiveSettings(job);
  const auto map = loadPoleMap(job.map, settings.likelihood);
  std::vector<StampedPose2D> truth;
  if (job.truth) truth = io::planar(io::readTum(*job.truth));
  // Before the work, so that folders and windows that cannot be are known now.
  RunFolder folder(job.output);
  for (const auto& input : {job.config, job.input, job.map, job.truth.value_or("")})
    folder.protect(input);
  RunView view(settings.view, map->poles(), job.input.filename().string(), folder);

  const auto begin = Clock::now();
  const PoleSequence sequence = readPoles(job, settings);
  const double reading = secondsSince(begin);
  requireUsable(job.input.string(), sequence);
  if (job.truth) requireCoverage(*job.truth, truth, sequence.frames);
  const StartOptions start = startFrom(settings.start, job, truth, sequence.frames);
  const LocalizeFacts facts{job,           settings.localization, start,
                            settings.runs, sequence.counts,       map->poles().size()};
  LocalizeResult result;
  result.runs =
      runAll(facts, LocalizationMap(map, settings.localization.global), sequence.frames, view);
  view.finish();
  if (job.truth)
    for (const auto& run : result.runs) result.errors.push_back(judge(run, truth));
  writeResults(folder, facts, settings, result, reading);
  if (!job.quiet) {
    printTable(std::cout, facts, result);
    std::cout << "results in " << job.output.string() << std::endl;
  }
  view.waitForWindow();
  return result;
}

namespace {

std::string wrongRate(const std::string& text) {
  try {
    report::parseRate(text);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

void addViewOptions(CLI::App& cli, LocalizeJob& job) {
  cli.add_flag("--live", job.live, "Show the first run in a window; closing it ends only the view");
  cli.add_flag("--hold", job.hold, "--live, and the window stays until it is closed");
  cli.add_option("--rate", job.rate, "Of the window: 1x as it was driven (default), 2.5x, max")
      ->check(wrongRate);
  cli.add_option("--scenes", job.scenes, "A .3Dscene every N scans, in OUTPUT/run_00_scenes")
      ->check(CLI::Range(0, 1000000000));
  cli.add_option("--frames", job.frames, "Folder for PNG frames; needs no display");
  cli.add_option("--frame-every", job.frameEvery, "A frame every N scans")
      ->check(CLI::Range(1, 1000000000));
}

}  // namespace

int localizeMain(int argc, const char* const* argv) {
  CommandLine line("pole-localize", "Localizes a vehicle in a pole map, from a rawlog.");
  LocalizeJob job;
  auto& cli = line.cli();
  cli.add_option("--config", job.config, "Settings (.ini)")->required();
  addSetOption(cli, job.set);
  cli.add_option("--input", job.input, "Rawlog of scans or of poles, with odometry")->required();
  cli.add_option("--map", job.map, "Pole map (.polemap)")->required();
  cli.add_option("--output", job.output, "Folder for the results")->required();
  cli.add_option("--truth", job.truth, "True robot poses (.tum): errors, and the start");
  cli.add_option("--runs", job.runs, "Runs, each with its own seed")->check(CLI::Range(1, 10000));
  cli.add_option("--seed", job.seed, "Seed of the first run; run i uses seed + i");
  cli.add_option("--particles", job.particles, "Particles of the filter")
      ->check(CLI::Range(1, 1000000));
  auto* start = cli.add_option("--start", job.start,
                               "X,Y,YAW_DEG,RADIUS,HEADING_DEG: where it starts, m and deg")
                    ->delimiter(',')
                    ->expected(5);
  cli.add_flag("--global", job.anywhere, "No start pose: the whole map is searched on the way")
      ->excludes(start);
  addViewOptions(cli, job);
  cli.add_flag("--allow-truncated", job.allowTruncated,
               "Use the readable part of a rawlog that ends too early");
  return line.run(argc, argv, [&] {
    job.quiet = line.quiet();
    localize(job);
  });
}

}  // namespace polemcl::apps
