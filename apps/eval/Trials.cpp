#include "eval/Trials.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "cli/Progress.h"
#include "core/common/Angles.h"
#include "eval/EvalApp.h"
#include "io/file/TextFile.h"
#include "localize/LocalizeApp.h"

namespace polemcl::apps {
namespace {

std::vector<std::size_t> drawStarts(const std::vector<double>& driven,
                                    const TrialOptions& options) {
  const double length = driven.empty() ? 0 : driven.back();
  if (length <= options.metres)
    throw Error("the drive is " + io::fixed(length, 1) + " m long, but each trial takes " +
                io::fixed(options.metres, 1) + " m: give a longer one or fewer metres");
  const auto last = std::upper_bound(driven.begin(), driven.end(), length - options.metres);
  const auto count = static_cast<std::uint64_t>(last - driven.begin());
  std::mt19937_64 random(options.seed);
  std::vector<std::size_t> starts(options.trials);
  for (std::size_t& start : starts) start = random() % count;
  return starts;
}

/// A pose of which the true one is as far as `[start]` allows.
Pose2D poseNear(const Pose2D& truth, const StartOptions& settings, std::uint32_t seed) {
  std::mt19937_64 random(seed);
  const double distance = settings.radius * std::sqrt(uniform(random, 0, 1));
  const double direction = uniform(random, -M_PI, M_PI);
  return {truth.x + distance * std::cos(direction), truth.y + distance * std::sin(direction),
          wrapAngle(truth.yaw + uniform(random, -settings.heading, settings.heading))};
}

struct TrialKind {
  const char *name, *meaning;
  TrialMaker (*maker)(const TrialDrive&, const TrialOptions&);
  Figures (*figures)(const TrialDrive&, const TrialOptions&, const std::vector<TrialOutcome>&);
  void (*declare)(CLI::App&, TrialOptions&);  ///< options that not all kinds have
};

void declareMetres(CLI::App& cli, TrialOptions& options) {
  addNumber(cli, "--metres", options.metres, "Longest path of a trial, m", positiveNumber());
}

void declareFault(CLI::App& cli, TrialOptions& options) {
  std::vector<std::pair<std::string, Fault>> faults;
  for (const Fault fault :
       {Fault::none, Fault::kidnap, Fault::wrongMap, Fault::blind, Fault::stuck, Fault::slip,
        Fault::jump, Fault::clock, Fault::moved, Fault::halfGone, Fault::snow, Fault::late})
    faults.emplace_back(name(fault), fault);
  addChoice(cli, "--fault", options.fault.fault, faults,
            "Kind of fault; none: the whole drive as it is")
      ->required();
  addFile(cli, "--other-map", options.otherMap, "The wrong map (.polemap), for wrong-map");
  const auto number = [&](const char* flag, double& value, const char* meaning) {
    addNumber(cli, flag, value, meaning, positiveNumber());
  };
  number("--lead", options.fault.lead, "Time before the fault, s");
  number("--duration", options.fault.duration, "Duration of a fault that lasts, s");
  number("--tail", options.fault.tail, "Path after the fault, m");
  addNumber(cli, "--slip", options.fault.slip, "Error of the slipping odometry's scale, as a share",
            positiveNumber() & CLI::Range(0.0, 1.0));
}

constexpr TrialKind kKinds[] = {
    {"global", "Starts at random places without a pose: is the pose found?", startsAnywhere,
     globalFigures, declareMetres},
    {"starts",
     "Starts at random places with a pose as rough as [start] says: does the filter find the true "
     "one?",
     startsNearby, startFigures, declareMetres},
    {"faults", "Injects faults into a drive: are they noticed, does localization recover?",
     faultyStretches, faultFigures, declareFault},
};

void declareTrials(CLI::App& cli, TrialOptions& options) {
  addConfigOption(cli, options.files.config)->required();
  addSetOption(cli, options.files.set);
  addFile(cli, "--map", options.files.map, "Pole map (.polemap)")->required();
  addFile(cli, "--input", options.files.input, "Rawlog of poles, with odometry")->required();
  addFile(cli, "--truth", options.files.truth, "True robot poses of the drive (.tum)")->required();
  addNumber(cli, "--trials", options.trials, "Number of trials, each at another place",
            CLI::Range(1, 1000000));
  cli.add_option("--seed", options.seed, "Seed of the places; the filter of trial i uses seed + i")
      ->capture_default_str();
}

Figures trialFigures(const TrialKind& kind, TrialOptions options) {
  const bool otherMap = options.fault.fault == Fault::wrongMap;
  if (otherMap && !options.otherMap)
    throw Error("--fault wrong-map needs --other-map, the wrong one");
  if (otherMap) options.files.map = *options.otherMap;
  const TrialDrive drive = loadTrialDrive(options.files);
  Progress progress("trials", static_cast<std::size_t>(options.trials), options.quiet);
  options.progress = [&] { progress.step(); };
  return kind.figures(drive, options, runTrials(drive, options, kind.maker(drive, options)));
}

}  // namespace

TrialMaker startsAnywhere(const TrialDrive& drive, const TrialOptions& options) {
  const auto starts = drawStarts(drive.driven, options);
  return [&drive, starts, metres = options.metres](std::uint32_t index) {
    const std::size_t first = starts[index];
    std::size_t end = first;
    while (end < drive.frames.size() && drive.driven[end] - drive.driven[first] <= metres) ++end;
    return stretchOf(drive, first, end);
  };
}

TrialMaker startsNearby(const TrialDrive& drive, const TrialOptions& options) {
  return [&drive, seed = options.seed,
          anywhere = startsAnywhere(drive, options)](std::uint32_t index) {
    Trial trial = anywhere(index);
    trial.start = poseNear(trial.truth[0], drive.settings.start, seed + index);
    return trial;
  };
}

TrialMaker faultyStretches(const TrialDrive& drive, const TrialOptions& options) {
  return [&drive, seed = options.seed, fault = options.fault](std::uint32_t index) {
    std::mt19937_64 random((static_cast<std::uint64_t>(seed) << 32) + index);
    return injectFault(drive, fault, random);
  };
}

std::vector<TrialOutcome> runTrials(const TrialDrive& drive, const TrialOptions& options,
                                    const TrialMaker& maker) {
  SettingsValues values = drive.settings;
  values.start.anywhere = false;  // each trial says itself where it starts
  values.start.pose.reset();
  const Settings settings(values);
  std::vector<TrialOutcome> outcomes(options.trials);
  tbb::parallel_for(0, options.trials, [&](int i) {
    const auto index = static_cast<std::uint32_t>(i);
    const Trial trial = maker(index);
    outcomes[i] = outcomeOf(trial, record(trial, settings, drive.map, options.seed + index));
    if (options.progress) options.progress();
  });
  return outcomes;
}

std::vector<Subcommand> trialCommands(CLI::App& program) {
  std::vector<Subcommand> commands;
  for (const TrialKind& kind : kKinds)
    commands.push_back(evalCommand<TrialOptions>(
        program, kind.name, kind.meaning,
        [&kind](CLI::App& cli, TrialOptions& options) {
          declareTrials(cli, options);
          kind.declare(cli, options);
        },
        [&kind](const TrialOptions& options) { return trialFigures(kind, options); }));
  return commands;
}

}  // namespace polemcl::apps
