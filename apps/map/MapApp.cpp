#include "map/MapApp.h"

#include <algorithm>
#include <iostream>
#include <set>

#include "cli/CommandLine.h"
#include "cli/Progress.h"
#include "cli/Version.h"
#include "io/file/TextFile.h"
#include "io/map/PoleMapFile.h"
#include "io/map/PolePositions.h"
#include "map/MapConvertApp.h"
#include "map/MapDiffApp.h"
#include "map/MapUpdateApp.h"
#include "map/MappingSession.h"
#include "report/scene/MapScene.h"

namespace polemcl::apps {
namespace {

/// Sessions before, none unless `add` is given.
MapAccumulator accumulator(const MapOptions& options, const Settings& settings) {
  if (!options.add) return {settings.map, settings.upkeep};
  auto scans = io::readMapScans(*options.add);
  if (!scans)
    throw Error(options.add->string() +
                ": keeps no scans, so none can be added; build it with --keep-scans");
  try {
    return {settings.map, settings.upkeep, std::move(*scans)};
  } catch (const Error& error) {
    throw Error(options.add->string() + ": " + error.what());
  }
}

/// That of the options, or of the map that is added to: both must be the same.
std::optional<io::Datum> datumFor(const MapOptions& options) {
  if (!options.add) return options.datum;
  const std::string where = options.add->string() + ": ";
  auto info = io::readPoleMap(*options.add).info;
  if (options.datum) io::setDatum(info, *options.datum, where);
  return io::datumOf(info, where);
}

void addDrive(const MapOptions& options, std::size_t drive, MappingSession found,
              MapAccumulator& sessions, MapSummary& summary) {
  if (!options.dates.empty()) setDate(found.scans, options.dates[drive]);
  sessions.add(options.inputs[drive].filename().string(), std::move(found.scans));
  summary.unmatched += found.unmatched;
  summary.emptyScans += found.emptyScans;
  summary.invalidPoints += found.invalidPoints;
  summary.truncated += found.truncated;
}

void countSessions(const AddedSessions& added, MapSummary& summary) {
  for (const AddedSession& session : added.sessions) {
    summary.sessions.push_back(
        {session.name, session.scans.size(), session.usedCount(), session.usedShare()});
    summary.visited += session.scans.size();
    summary.scans += session.usedCount();
  }
}

std::vector<StampedPose2D> pathOf(const AddedSessions& added) {
  std::vector<StampedPose2D> path;
  for (const AddedSession& session : added.sessions)
    for (const SessionScan& scan : session.scans) path.push_back({scan.time, scan.pose_map_robot});
  return path;
}

std::string noPoles(const MapSummary& summary, const PoleMapOptions& options) {
  const auto& map = summary.map;
  const std::size_t steps = summary.visited - std::min(summary.visited, summary.sessions.size());
  const double spacing = steps > 0 ? map.pathLength / static_cast<double>(steps) : 0;
  return "no pole found: " + std::to_string(summary.scans) + " scans " + io::fixed(spacing, 2) +
         " m apart on average; sections of section_length_m = " +
         io::significant(options.sectionLength, 6) + ", " + std::to_string(map.occupiedSections) +
         " of " + std::to_string(map.sections) + " with a scan; " + std::to_string(map.detections) +
         " detections in " + std::to_string(map.clusters) + " places, the best with " +
         std::to_string(map.bestCount) +
         (options.counting == PoleCounting::members
              ? " detections, min_count = " + std::to_string(options.minCount) + " are needed"
              : " sections of one run, min_count = " + std::to_string(options.minCount) +
                    " are needed, max_gap = " + std::to_string(options.maxGap)) +
         (map.detections == 0 ? "; see [sensor] and [extraction]" : "; see [map]");
}

/// `f_map.NAME` of each session; of equal names the second is `f_map.NAME.2`.
void addShares(const MapSummary& summary, std::map<std::string, std::string>& info) {
  for (const MapSummary::Session& session : summary.sessions) {
    const std::string key = "f_map." + std::filesystem::path(session.name).stem().string();
    std::string unique = key;
    for (int n = 2; info.count(unique) > 0; ++n) unique = key + '.' + std::to_string(n);
    info[unique] = io::fixed(session.share, 6);
  }
}

std::map<std::string, std::string> facts(const Settings& settings, const MapSummary& summary,
                                         const std::optional<io::Datum>& datum) {
  std::string names;
  for (const MapSummary::Session& session : summary.sessions)
    names += (names.empty() ? "" : " ") + session.name;
  std::map<std::string, std::string> info{
      {"program", std::string("pole-map ") + version()},
      {"build", buildIdentity()},
      {"inputs", names},
      {"scans", std::to_string(summary.scans)},
      {"path_length_m", io::fixed(summary.map.pathLength, 3)},
      {"sections", std::to_string(summary.map.sections)},
      {"occupied_sections", std::to_string(summary.map.occupiedSections)},
      {"detections", std::to_string(summary.map.detections)},
      {"config", settingsText(settings)}};
  addShares(summary, info);
  if (datum) info[io::kDatumKey] = io::datumText(*datum);
  return info;
}

void printMap(const MapSummary& summary, const MapOptions& options) {
  std::cout << options.output.string() << ": " << summary.map.poles.size() << " poles from "
            << summary.scans << " scans over " << io::fixed(summary.map.pathLength, 1) << " m\n"
            << "sections: " << summary.map.occupiedSections << " of " << summary.map.sections
            << " with a scan; detections " << summary.map.detections << " in "
            << summary.map.clusters << " places\n";
  if (summary.sessions.size() > 1)
    for (const MapSummary::Session& session : summary.sessions)
      std::cout << session.name << ": " << session.used << " of " << session.scans
                << " scans used, f_map " << io::fixed(session.share, 4) << '\n';
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
  if (!dates.empty() && dates.size() != inputs.size())
    throw Error("--date: one day per --input is needed, or none; " + std::to_string(inputs.size()) +
                ", not " + std::to_string(dates.size()));
  if (output.extension() != ".polemap")
    throw Error("--output " + output.string() + ": the name must end in .polemap");
}

MapSummary buildMap(const MapOptions& options, const Settings& settings,
                    const ScanProgress& progress) {
  options.validate();
  MapSummary summary;
  const auto datum = datumFor(options);
  MapAccumulator sessions = accumulator(options, settings);
  for (std::size_t i = 0; i < options.inputs.size(); ++i)
    addDrive(options, i,
             loadMappingSession(options.inputs[i], options.truths[i], settings,
                                options.allowTruncated, progress),
             sessions, summary);
  countSessions(sessions.added(), summary);
  if (summary.scans == 0)
    throw Error(options.inputs.front().string() + ": no usable scan, " +
                std::to_string(summary.emptyScans) + " without a valid point");
  summary.map = sessions.build();
  if (summary.map.poles.empty()) throw Error(noPoles(summary, settings.map));

  const io::PoleMapData map =
      io::mapData(sessions.withHistories(summary.map.poles), facts(settings, summary, datum));
  if (options.csv) io::writePoleCsv(*options.csv, map.poles, map.histories);
  if (options.scene) {
    report::MapView view;
    view.title = options.output.filename().string();
    view.poles = summary.map.poles;
    view.truth = pathOf(sessions.added());
    scene::save(*report::makeMapScene(view), *options.scene);
  }
  io::writePoleMap(options.output, map,
                   options.keepScans || options.add ? &sessions.added() : nullptr);
  return summary;
}

namespace {

/// All that the command line of `pole-map` says.
struct MapLine {
  MapOptions build;
  std::string config;
  std::vector<std::string> set;
  std::optional<std::filesystem::path> update, png, convert;
  std::string datum;
  std::vector<std::filesystem::path> diff;
};

void addOptions(CLI::App& cli, MapLine& line) {
  addSetOption(cli, line.set);
  cli.add_option("--config", line.config, "INI file, see config/");
  cli.add_option("--input", line.build.inputs, "Rawlogs of scans or poles");
  cli.add_option("--truth", line.build.truths, "True robot poses, TUM, one file per rawlog");
  cli.add_option("--output", line.build.output, "Map to write, .polemap");
  cli.add_option("--date", line.build.dates,
                 "Day of each rawlog, YYYY-MM-DD, where its times do not tell");
  cli.add_option(
      "--update", line.update,
      "Map to begin with: each rawlog is a session that keeps it true, see [map_update]");
  auto* add = cli.add_option("--add", line.build.add,
                             "Map that keeps its scans: each rawlog is a session after those it "
                             "was made from");
  cli.add_flag("--keep-scans", line.build.keepScans,
               "Keep the used scans' poles in the map, so that --add can go on from it");
  cli.add_option("--datum", line.datum,
                 "Of the truth: LAT,LON of the origin, and the heading of x from east")
      ->type_name("LAT,LON[,YAW_DEG]");
  cli.get_option("--update")->excludes(add);
  auto* diff = cli.add_option("--diff", line.diff, "List what changed from one map to another")
                   ->expected(2)
                   ->type_name("A B");
  auto* convert = cli.add_option("--convert", line.convert,
                                 "Map to write as another kind of file, by the endings: .polemap, "
                                 ".csv, .npz, .geojson");
  for (auto* option : {diff, add, cli.get_option("--update"), cli.get_option("--input")})
    convert->excludes(option);
  cli.add_option("--scene", line.build.scene, "Also write a .3Dscene of the map, or the changes");
  cli.add_option("--csv", line.build.csv, "Also write the poles, or the changes, to this table");
  cli.add_option("--png", line.png, "With --diff: draw the changes")->needs(diff);
  cli.add_flag("--allow-truncated", line.build.allowTruncated,
               "Use the readable part of rawlogs that were cut short");
}

/// Of two outputs with one name, one would be lost.
void requireApart(const MapLine& line) {
  std::set<std::filesystem::path> names;
  for (const auto& output :
       {std::optional(line.build.output), line.build.csv, line.build.scene, line.png})
    if (output && !output->empty() && !names.insert(output->lexically_normal()).second)
      throw CLI::ValidationError(output->string(), "is given for two outputs");
}

/// What CLI11 cannot know: --diff needs nothing else, all others need four options.
void requireUsage(const MapLine& line) {
  const MapOptions& build = line.build;
  requireApart(line);
  if (!line.set.empty() && line.config.empty())
    throw CLI::ValidationError("--set",
                               "takes the place of settings of --config, which is missing");
  if (build.keepScans && line.update)
    throw CLI::ValidationError("--keep-scans", "an updated map keeps no scans; leave it out");
  if (!line.diff.empty()) {
    if (line.update || build.add || !build.inputs.empty() || !build.output.empty())
      throw CLI::ValidationError("--diff", "compares two maps; it takes no other input or output");
    return;
  }
  if (line.convert) {
    if (!line.config.empty())
      throw CLI::ValidationError("--convert", "takes no --config: it has no settings");
    if (build.output.empty()) throw CLI::RequiredError("--output");
    return;
  }
  if (line.config.empty()) throw CLI::RequiredError("--config");
  if (build.inputs.empty()) throw CLI::RequiredError("--input");
  if (build.truths.empty()) throw CLI::RequiredError("--truth");
  if (build.output.empty()) throw CLI::RequiredError("--output");
  if (build.inputs.size() != build.truths.size())
    throw CLI::ValidationError("--truth", "one file per --input is needed");
  if (!build.dates.empty() && build.dates.size() != build.inputs.size())
    throw CLI::ValidationError("--date", "one day per --input is needed, or none");
}

void runDiff(const MapLine& line, bool quiet) {
  const MapUpdateOptions upkeep =
      line.config.empty() ? MapUpdateOptions() : loadSettings(line.config, line.set).upkeep;
  const MapDiff diff =
      diffMapFiles({line.diff[0], line.diff[1], line.build.csv, line.png, line.build.scene},
                   {upkeep.moved, upkeep.ghost});
  if (!quiet) apps::print(diff, std::cout);
}

void runConvert(const MapLine& line, bool quiet) {
  const MapConvertOptions options{*line.convert, line.build.output, line.build.datum};
  const auto summary = convertMap(options);
  if (!quiet) apps::print(summary, options);
}

void runUpdate(const MapLine& line, bool quiet) {
  const MapOptions& o = line.build;
  const MapUpdateJob options{*line.update, o.inputs, o.truths,         o.dates, o.output,
                             o.scene,      o.csv,    o.allowTruncated, o.datum};
  const auto settings = loadSettings(line.config, line.set);
  MapUpdateSummary summary;
  {
    Progress progress("update", 0, quiet);
    summary = updateMapFile(options, settings, [&](std::size_t done, std::size_t total) {
      progress.update(done, total);
    });
  }
  if (!quiet) apps::print(summary, options);
}

void runBuild(const MapLine& line, bool quiet) {
  const auto settings = loadSettings(line.config, line.set);
  MapSummary summary;
  {
    Progress progress("map", 0, quiet);
    summary = buildMap(line.build, settings,
                       [&](std::size_t done, std::size_t total) { progress.update(done, total); });
  }
  if (!quiet) printMap(summary, line.build);
}

}  // namespace

int mapMain(int argc, const char* const* argv) {
  CommandLine line("pole-map",
                   "Builds a pole map from scans, or poles, at known poses; keeps it true; "
                   "compares two; converts them.");
  MapLine options;
  addOptions(line.cli(), options);
  line.cli().parse_complete_callback([&] { requireUsage(options); });
  return line.run(argc, argv, [&] {
    if (!options.datum.empty()) options.build.datum = io::parseDatum(options.datum, "--datum: ");
    if (!options.diff.empty())
      runDiff(options, line.quiet());
    else if (options.convert)
      runConvert(options, line.quiet());
    else if (options.update)
      runUpdate(options, line.quiet());
    else
      runBuild(options, line.quiet());
  });
}

}  // namespace polemcl::apps
