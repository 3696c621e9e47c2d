#include "localize/LocalizeApp.h"

#include <cmath>
#include <iostream>
#include <mutex>

#include "cli/CommandLine.h"
#include "cli/JsonFile.h"
#include "cli/Messages.h"
#include "cli/Outputs.h"
#include "cli/Progress.h"
#include "cli/SensorCounts.h"
#include "cli/Settings.h"
#include "core/common/Angles.h"
#include "core/common/Binder.h"
#include "io/data/Trajectory.h"
#include "io/file/ErrorPlace.h"
#include "io/map/PoleMapFile.h"
#include "localize/LiveDrive.h"
#include "localize/LocalizePlayer.h"
#include "localize/LocalizeReport.h"
#include "localize/Pace.h"
#include "localize/PoseStream.h"
#include "localize/RunBag.h"
#include "localize/RunFolder.h"
#include "localize/RunView.h"
#include "mrpt/observation/ObservationPoints.h"

namespace polemcl::apps {

namespace {

/// Same times in most directions; close to the cut, small differences make a whole turn.
bool agree(const ScanTiming& set, const ScanTiming& stated) {
  constexpr double tolerance = 0.01;  // s
  constexpr int directions = 16;
  int apart = 0;
  for (int i = 0; i < directions; ++i) {
    const double azimuth = 2 * M_PI * i / directions;
    apart += std::abs(set.offset(azimuth) - set.clock - stated.offset(azimuth)) > tolerance;
  }
  return 2 * apart < directions;
}

/// A warning for each LiDAR of a scan that states its measuring times where `turn` and the
/// keys beside it set others. The settings win, so the poles are then moved wrongly.
std::vector<std::string> turnWarnings(const ReadScan& scan, const SequenceOptions& options) {
  std::vector<std::string> warnings;
  for (const auto& source : scan.sources) {
    const auto lidar = options.vehicle.indexOf(source->sensorLabel);
    const SensorOptions& sensor =
        lidar ? options.vehicle.lidars[*lidar].sensor : options.extraction.sensor;
    if (sensor.timing.turn == Turn::automatic) continue;
    ObservationPoints points(sensor);
    const ObservationPoints::Loan loan(points);
    points.read(*source);
    if (!points.timing() || agree(sensor.timing, *points.timing())) continue;
    warnings.push_back("[sensor" + (lidar ? ":" + source->sensorLabel : "") + "] turn = " +
                       name(sensor.timing.turn) + " and the keys beside it contradict " +
                       "the times that the LiDAR " + source->sensorLabel +
                       " states: poses of a moving robot get worse; set turn = auto");
  }
  return warnings;
}

/// X,Y,YAW_DEG,RADIUS,HEADING_DEG of the command line.
void setStart(StartOptions& start, const std::vector<double>& numbers) {
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

AllSettings effectiveSettings(const LocalizeJob& job) {
  AllSettings settings = loadSettings(job.config.string(), job.set);
  if (job.runs) settings.runs.runs = *job.runs;
  if (job.seed) settings.runs.seed = *job.seed;
  if (job.particles) settings.localization.filter.particles = *job.particles;
  if (job.anywhere || job.startByGnss) settings.start.anywhere = true;
  if (!job.start.empty()) setStart(settings.start, job.start);
  setView(settings.view, job);
  checkOptions(settings.runs);
  checkOptions(settings.localization);
  checkOptions(settings.start);
  return settings;
}

/// What is known before the first scan; the truth gives the start where nothing else does.
LocalizeFacts factsOf(const LocalizeJob& job, const AllSettings& settings, const CPoleMap& map) {
  LocalizeFacts facts{job, settings, "", {}, map.poles().size(), {}};
  if (job.startByGnss) {
    facts.datum = io::datumOf(map.info, job.map.string());
    if (!facts.datum)
      throw Error(job.map.string() +
                  ": has no datum, so a position from satellites says nothing "
                  "about places on it: start with --start or --global");
    facts.startSource = "gnss";
  } else if (facts.settings.start.anywhere)
    facts.startSource = "anywhere";
  else if (!job.start.empty())
    facts.startSource = "command line";
  else if (facts.settings.start.pose)
    facts.startSource = "configuration";
  else if (job.truth)
    facts.startSource = "truth";
  else
    throw Error("no start pose: set position_m and yaw_deg in [start] of " + job.config.string() +
                ", or give --start, --global or --truth");
  return facts;
}

/// Times as fast as it was recorded; none: full speed. `[view] rate` is for windows only.
std::optional<double> rateOf(const LocalizeJob& job, const AllSettings& settings) {
  if (job.isLive()) return 1;
  return job.rate || settings.view.live ? report::parseRate(settings.view.rate) : std::nullopt;
}

/// What ends a drive from sensors from outside. From any thread.
class DriveEnd {
 public:
  /// \param seconds After its construction; 0: never.
  explicit DriveEnd(double seconds) : m_seconds(seconds) {}
  bool isReached() const {
    return EndSignals::came() || (m_seconds > 0 && secondsSince(m_begin) >= m_seconds);
  }

 private:
  const EndSignals m_signals;
  const double m_seconds;
  const ScanClock::time_point m_begin = ScanClock::now();
};

/// Streams the rawlog, or the sensors, to the player. A rawlog has no failure. A drive ends when
/// its stream does; a rawlog is read to its end.
LiveDriveResult play(const LocalizeJob& job, const AllSettings& settings, const RunView& view,
                     LocalizePlayer& player, PoseStream* stream,
                     const std::function<bool()>& goesOn) {
  SequenceOptions options = settings.reading();
  options.allowTruncated = job.allowTruncated;
  options.follow = job.follow;
  // Where the user steers, the view sets the pace.
  Pace pace(rateOf(job, settings),
            [&] { return view.isOpen() ? view.follows() : job.rate.has_value(); });
  options.pace = [&](double time, const auto& work) { return pace.waitFor(time, work); };
  Progress progress("localize", 0, job.quiet);
  std::mutex ofProgress;
  const auto warn = [&](const std::string& text) {
    const std::lock_guard lock(ofProgress);
    progress.say(warningLine("pole-localize", oneLine(text)));
  };
  std::size_t jumps = 0;
  const auto take = [&](const ReadScan& scan) {
    player.take(scan);
    if (job.isLive() && scan.index == 0)
      for (const std::string& text : turnWarnings(scan, options)) warn(text);
    if (job.isLive() && scan.odometryJumps > 0 && jumps == 0)
      warn(job.source().string() +
           ": the odometry jumped: the motion before goes on instead, as at later jumps");
    jumps = scan.odometryJumps;
    const std::lock_guard lock(ofProgress);
    progress.update(scan.index + 1, scan.expected);
  };
  if (!job.isLive()) return {streamPoles(job.input.string(), options, take), ""};
  LiveDriveOptions drive{job.sensors, job.record, settings.localization.maxGap};
  drive.warn = warn;
  drive.goesOn = [&] { return goesOn() && (!stream || stream->failure().empty()); };
  if (stream) drive.gap = [stream] { stream->addGap(); };
  return streamSensors(drive, options, take);
}

void writeResults(RunFolder& folder, const LocalizeFacts& facts, const AllSettings& settings,
                  const LocalizeResult& result) {
  saveSettings(settings, folder.staged("config.ini").string());
  writeJson(folder.staged("timings.json"), timingsJson(result.timings));
  writeJson(folder.staged("summary.json"), makeSummary(facts, result));
  folder.commit();
}

void warnOfLeftovers(const RunFolder& folder) {
  for (const std::filesystem::path& left : folder.leftovers())
    std::cerr << warningLine(
                     "pole-localize",
                     left.string() +
                         ": is left of a run that was killed, its results up to then are in "
                         "it; remove it when you do not need them")
              << '\n';
}

void warnOfErrors(const SpreadCheck& check, const std::filesystem::path& truth) {
  if (!check.contradicts()) return;
  std::cerr << warningLine("pole-localize",
                           std::to_string(100 * check.beyond / check.ok) +
                               " % of the scans that were ok are more than 0.5 m and 5 times the "
                               "spread of the pose away from " +
                               truth.string() +
                               ": truth of another drive, of other times or of another frame than "
                               "the map's (made without --truth it begins at its first scan), or "
                               "a sure but wrong pose; pole-eval motion compares it "
                               "with the poles")
            << '\n';
}

/// What pole-map kept in a map that it doubted; empty for others.
std::string warningsOfMap(const std::filesystem::path& file) {
  const auto info = io::readPoleMap(file).info;
  const auto found = info.find("warnings");
  return found == info.end() ? "" : " The map was made with warnings: " + found->second;
}

/// A short drive may end before its pose is confirmed; it is not lost.
/// \param doubts warningsOfMap()
void warnIfLost(const LocalizeResult& result, const LocalizeJob& job, const std::string& doubts) {
  std::size_t scans = 0, ok = 0, lost = 0;
  for (const auto& run : result.runs) {
    scans += run.scans;
    ok += run.states[static_cast<int>(HealthState::ok)];
    lost += run.states[static_cast<int>(HealthState::lost)];
  }
  if (ok > 0 || 2 * lost < scans) return;
  std::cerr << warningLine("pole-localize", "no pose was ok, most were lost: is " +
                                                job.map.string() +
                                                " a map of another place, the start wrong, the "
                                                "configuration that of another LiDAR, the odometry "
                                                "in another frame, or [sensor] turn wrong?" +
                                                doubts)
            << '\n';
}

}  // namespace

std::shared_ptr<const CPoleMap> loadPoleMap(const std::filesystem::path& file,
                                            const LikelihoodOptions& likelihood) {
  auto map = std::make_shared<CPoleMap>();
  map->likelihoodOptions = likelihood;  // first: loading prepares the index for its gate
  map->loadFromPoleMapFile(file.string());
  if (map->poles().empty())
    throw Error(file.string() + ": the map has no poles: nothing can be localized in it");
  return map;
}

LocalizeResult localize(const LocalizeJob& job) {
  const AllSettings settings = effectiveSettings(job);
  const auto map = loadPoleMap(job.map, settings.likelihood);
  const std::string doubts = warningsOfMap(job.map);  // the file may be replaced during the drive
  std::vector<StampedPose2D> truth;
  if (job.truth) truth = io::readPlanarTum(*job.truth);
  LocalizeFacts facts = factsOf(job, settings, *map);
  // Before the work, so that folders and windows that cannot be are known now.
  RunFolder folder(job.output);
  for (const auto& input : {job.config, job.source(), job.map, job.truth.value_or("")})
    folder.protect(input);
  warnOfLeftovers(folder);
  using Source = report::Playback::Source;
  RunView view(settings.view,
               {map->poles(), job.source().filename().string(), job.truth ? &truth : nullptr,
                settings.reading(), job.isLive() ? Source::sensors : Source::rawlog},
               folder);

  const LocalizationMap prepared(map);
  const auto begin = ScanClock::now();
  std::optional<PoseStream> stream;
  std::optional<DriveEnd> end;
  const auto goesOn = [&end] { return !end || !end->isReached(); };
  if (job.isLive()) end.emplace(job.seconds);
  if (job.stream) stream.emplace(*job.stream, goesOn);
  std::optional<RunBag> bag;
  if (job.bag) bag.emplace(*job.bag);
  LocalizePlayer player(facts, prepared, job.truth ? &truth : nullptr, folder, view,
                        stream ? &*stream : nullptr, bag ? &*bag : nullptr);
  const LiveDriveResult drive =
      play(job, settings, view, player, stream ? &*stream : nullptr, goesOn);
  std::string failure = drive.failure.empty() && stream ? stream->failure() : drive.failure;
  if (!failure.empty() && drive.counts.scans == 0) throw Error(failure);
  facts.counts = drive.counts;
  const std::string useless = player.whyUseless();
  // A drive cannot be repeated: what came of it is kept.
  if (!useless.empty() && !(job.isLive() && drive.counts.scans > 0)) throw Error(useless);
  if (failure.empty()) failure = useless;
  LocalizeResult result = player.finish();
  result.timings.wallSeconds = secondsSince(begin);
  result.timings.rate = rateOf(job, settings);
  writeResults(folder, facts, settings, result);
  if (bag) keep(*bag, failure);
  end.reset();
  if (!job.quiet) {
    std::ostream& out = job.stream == "-" ? std::cerr : std::cout;
    printTable(out, facts, result);
    out << timingsLine(result.timings) << "\nresults in " << job.output.string() << std::endl;
  }
  for (const std::string& doubt : turnDoubts(drive.counts, settings.sensor.timing))
    std::cerr << warningLine("pole-localize", job.source().string() + ": " + doubt) << '\n';
  if (job.truth) warnOfErrors(result.spreadCheck, *job.truth);
  warnIfLost(result, job, doubts);
  view.waitForWindow();
  if (!failure.empty())
    throw Error(failure +
                (job.isLive() ? "; the results up to then are in " : "; the results are in ") +
                job.output.string());
  return result;
}

namespace {

/// A rawlog, or sensors; never both.
void addSources(CLI::App& cli, LocalizeJob& job) {
  auto* input = addFile(cli, "--input", job.input,
                        "Rawlog of scans or of poles, with odometry; this or --sensors is needed");
  auto* sensors =
      cli.add_option("--sensors", job.sensors,
                     "In place of --input: sensors (.ini of MRPT's rawlog-grabber), until Ctrl-C")
          ->type_name("INI")
          ->excludes(input);
  addNumber(cli, "--for", job.seconds, "End a drive with --sensors after this time, s; 0: never",
            CLI::Range(0.0, 1e6))
      ->needs(sensors);
  addOutput(cli, "--record", job.record,
            "Rawlog of what is taken from the sensors; played as --input, it gives the same poses")
      ->needs(sensors);
  addNumber(
      cli, "--follow", job.follow,
      "Wait at the end of a rawlog that still grows, until nothing has come for this time, s; "
      "0: do not wait",
      CLI::Range(0.0, 86400.0))
      ->excludes(sensors);
  cli.add_flag("--allow-truncated", job.allowTruncated,
               "Use the readable part of a rawlog that ends too early")
      ->excludes(sensors);
}

void addViewOptions(CLI::App& cli, LocalizeJob& job) {
  cli.add_flag("--live", job.live,
               "Play the first run in a window, h lists its keys; closing it ends only the view");
  cli.add_flag("--hold", job.hold, "As --live, and keep the window until it is closed");
  cli.add_option("--rate", job.rate, "Speed of the input: 1x as driven, 2.5x, max")
      ->type_name("SPEED")
      ->default_str("max; with a window [view] rate")
      ->check(
          [](const std::string& text) { return io::problemOf([&] { report::parseRate(text); }); });
  cli.add_option("--scenes", job.scenes,
                 "Write a .3Dscene every N scans, into OUTPUT/run_00_scenes; 0: none")
      ->check(CLI::Range(0, 1000000000))
      ->default_str(unlessSet("[view] scenes", report::ViewOptions().scenes));
  addFolder(cli, "--frames", job.frames, "Folder for PNG frames; needs no display");
  cli.add_option("--frame-every", job.frameEvery, "Write a frame every N scans")
      ->check(CLI::Range(1, 1000000000))
      ->default_str(unlessSet("[view] frame_every", report::ViewOptions().frameEvery));
}

const Guides kLocalizeGuides{
    {"",
     {{"pole-localize --config demo.ini --input tuesday.rawlog --map street.polemap --truth "
       "tuesday.tum --output out --runs 5",
       "pole-localize --config demo.ini --input tuesday.rawlog --map street.polemap --global "
       "--output found --mcap found.mcap",
       "pole-localize --config vlp16.ini --sensors live/vlp16.ini --map street.polemap --start "
       "0,0,0,2,5 --output out --stream -"},
      "Keys of --live: space pauses, arrows step and skip, digits and enter go to a time, n to the "
      "next degraded or lost scan; h lists all. They change no result. "
      "Evaluate and draw a run: pole-eval trajectory --truth tuesday.tum --estimate out/run_00.tum "
      "--map street.polemap --png run.png."}},
};

}  // namespace

int localizeMain(int argc, const char* const* argv) {
  CommandLine line("pole-localize",
                   "Localizes a vehicle in a pole map, from a rawlog or from sensors.",
                   kLocalizeGuides);
  LocalizeJob job;
  auto& cli = line.cli();
  addConfigOption(cli, job.config)->required();
  addSetOption(cli, job.set);
  addSources(cli, job);
  addFile(cli, "--map", job.map, "Pole map (.polemap)")->required();
  addFolder(cli, "--output", job.output, "Folder for the results")->required();
  addFile(cli, "--truth", job.truth, "True robot poses (.tum): errors, and the start");
  cli.add_option("--runs", job.runs, "Number of runs, each with its own seed")
      ->check(CLI::Range(1, 10000))
      ->default_str(unlessSet("[runs] runs", RunOptions().runs));
  cli.add_option("--seed", job.seed, "Seed of the first run; run i uses seed + i")
      ->default_str(unlessSet("[runs] seed", RunOptions().seed));
  cli.add_option("--particles", job.particles, "Number of particles of the filter")
      ->check(CLI::Range(1, 1000000))
      ->default_str(unlessSet("[filter] particles", FilterOptions().particles));
  auto* start = cli.add_option("--start", job.start,
                               "Pose at the start, and how far off it can be; m and deg")
                    ->type_name("X,Y,YAW_DEG,RADIUS,HEADING_DEG")
                    ->default_str("[start], else the truth")
                    ->delimiter(',')
                    ->expected(5);
  auto* global = cli.add_flag("--global", job.anywhere,
                              "Start without a pose: search the whole map during the drive")
                     ->excludes(start);
  cli.add_flag("--start-gnss", job.startByGnss,
               "Search the map only near the rawlog's position from satellites at its first scan; "
               "the map needs a datum")
      ->excludes(start)
      ->excludes(global)
      ->excludes(cli.get_option("--sensors"));
  addViewOptions(cli, job);
  cli.get_option("--sensors")->excludes(cli.get_option("--rate"));
  addOutput(cli, "--stream", job.stream,
            "File for the poses of the first run as they are made, a line of JSON a scan; - "
            "for standard output");
  addOutput(
      cli, "--mcap", job.bag,
      "Bag of ROS 2 (.mcap) of the first run, for Foxglove and rviz: poses, path, poles, health")
      ->check([](const std::string& file) {
        return std::filesystem::path(file).extension() == ".mcap" ? ""
                                                                  : file + ": must end in .mcap";
      });
  cli.parse_complete_callback([&] {
    if (job.input.empty() && !job.isLive()) throw CLI::RequiredError("--input or --sensors");
  });
  return line.run(argc, argv, [&] {
    job.quiet = line.quiet();
    localize(job);
  });
}

}  // namespace polemcl::apps
