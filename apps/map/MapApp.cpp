#include "map/MapApp.h"

#include <memory>
#include <sstream>

#include "cli/CommandLine.h"
#include "cli/Messages.h"
#include "cli/Outputs.h"
#include "cli/Progress.h"
#include "cli/Version.h"
#include "core/mapping/MapDiff.h"
#include "io/file/AtomicFile.h"
#include "io/file/TextFile.h"
#include "io/map/Datum.h"
#include "io/map/PoleMapFile.h"
#include "map/MapBuildReport.h"
#include "map/MapFiles.h"
#include "map/MapImportApp.h"
#include "map/MapUpdateApp.h"
#include "mrpt/drawing/SceneParts.h"
#include "report/picture/Pictures.h"
#include "report/scene/MapScene.h"

namespace polemcl::apps {
namespace {

/// What `build` and `update` take besides the files of their job.
struct MappingLine {
  std::string config, datum;
  std::vector<std::string> set;
};

void addDatumOption(CLI::App& cli, std::string& datum, const std::string& whose) {
  cli.add_option("--datum", datum,
                 "Origin of " + whose + " on Earth: LAT,LON, and the heading of x from east")
      ->type_name("LAT,LON[,YAW_DEG]")
      ->check([](const std::string& text) {
        return text.empty() ? "LAT,LON[,YAW_DEG] expected, not ''" : std::string();
      });
}

std::optional<io::Datum> datumOf(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(io::parseDatum(text, "--datum: "));
}

void declare(CLI::App& cli, MappingJob& job, MappingLine& line) {
  addConfigOption(cli, line.config)->required();
  addSetOption(cli, line.set);
  addFile(cli, "--input", job.inputs, "Rawlogs of scans or poles, one per session")->required();
  addFile(cli, "--truth", job.poses, "True robot poses, TUM, one file per rawlog");
  addOutput(cli, "--output", job.output, "Map to write, .polemap")->required();
  cli.add_option("--date", job.dates,
                 "Day of each rawlog, YYYY-MM-DD, when its times do not tell it")
      ->type_name("DATE");
  addDatumOption(cli, line.datum, "the truth");
  addOutput(cli, "--scene", job.scene, "Also write a .3Dscene of map, paths and loops");
  addOutput(cli, "--csv", job.csv, "Also write the poles to this table");
  cli.add_flag("--allow-truncated", job.allowTruncated,
               "Use the readable part of rawlogs that were cut short");
}

/// Without poses, a map is built from odometry.
void settle(MapBuildJob& job) {
  if (job.poses.empty()) job.kind = PoseKind::odometry;
  const bool found = job.kind == PoseKind::odometry;
  const auto check = [&](const std::vector<std::filesystem::path>& files, const char* option) {
    if (files.empty()) return;
    if (!found)
      throw CLI::ValidationError(std::string(option) + ": the poses are given; leave it out");
    if (files.size() != job.inputs.size())
      throw CLI::ValidationError(std::string(option) + ": one file per --input is needed, " +
                                 std::to_string(job.inputs.size()) + ", not " +
                                 std::to_string(files.size()));
  };
  check(job.gnss, "--gnss");
  check(job.trajectories, "--trajectory");
}
void settle(MapUpdateJob&) {}

CLI::Option* addEstimateOption(CLI::App& cli, MappingJob& job) {
  auto* estimate = cli.add_option_function<std::vector<std::filesystem::path>>(
      "--estimate",
      [&job](const std::vector<std::filesystem::path>& files) {
        job.poses = files;
        job.kind = PoseKind::estimate;
      },
      "Instead of --truth: run_NN.tum of pole-localize, one file per rawlog");
  estimate->type_name("FILE")->excludes(cli.get_option("--truth"));
  return estimate;
}

/// A subcommand that maps sessions by `work(job, settings, progress)`.
template <class Job, class Work>
Subcommand mappingCommand(CLI::App& cli, const std::shared_ptr<Job>& job, const Work& work) {
  const auto line = std::make_shared<MappingLine>();
  declare(cli, *job, *line);
  cli.parse_complete_callback([job] {
    settle(*job);
    if (const std::string wrong = job->wrongCounts(); !wrong.empty())
      throw CLI::ValidationError(wrong);
  });
  return {&cli, [job, line, work, name = cli.get_name()](bool quiet) {
            job->datum = datumOf(line->datum);
            const AllSettings settings = loadSettings(line->config, line->set);
            Progress progress(name, 0, quiet);
            const auto summary = work(*job, settings, progress.updates());
            for (const std::string& warning : warningsOf(summary, *job))
              progress.say(warningLine("pole-map", warning));
            return summaryText(summary, *job);
          }};
}

Subcommand buildCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand(
      "build", "Builds a map from sessions, at true poses or with odometry alone");
  const auto job = std::make_shared<MapBuildJob>();
  addFile(cli, "--add", job->add,
          "Map that keeps its scans; the rawlogs are added as later sessions");
  auto* keep = cli.add_flag("--keep-scans", job->keepScans,
                            "Keep the poles of the used scans in the map, for a later --add");
  Subcommand command = mappingCommand(cli, job, buildMap);
  auto* estimate = addEstimateOption(cli, *job);
  addFile(cli, "--inventory", job->inventory,
          "Map of `import` in which the rawlogs were localized: it is made as exact as the "
          "LiDAR")
      ->needs(estimate)
      ->excludes("--add")
      ->excludes(keep);
  estimate->needs("--inventory");
  addFile(cli, "--gnss", job->gnss,
          "Without --truth: positions from satellites (CSV: time, latitude, longitude, sigma), one "
          "file per rawlog; the map gets their datum. Without this option, those in the rawlogs");
  cli.add_flag("!--no-gnss", job->gnssOfRawlogs,
               "Use no positions from satellites, though the rawlogs have some")
      ->excludes("--gnss");
  markOutput(
      addFile(cli, "--trajectory", job->trajectories,
              "Without --truth: also write the poses found (TUM, covariances beside it), one "
              "file per rawlog"),
      {"_cov.csv"});
  addOutput(cli, "--png", job->png, "Also draw the map, the paths and the loops");
  return command;
}

Subcommand updateCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand(
      "update", "Updates a map by new sessions, one after the other, see [map_update]");
  const auto job = std::make_shared<MapUpdateJob>();
  addFile(cli, "--map", job->map, "Map to begin with, .polemap")->required();
  addOutput(cli, "--json", job->json, "Also write what changed to this file (JSON)");
  Subcommand command = mappingCommand(cli, job, updateMapFile);
  addEstimateOption(cli, *job);
  return command;
}

std::string place(const MapPole& pole, const char* between) {
  return io::fixed(pole.x, 3) + between + io::fixed(pole.y, 3);
}

/// The changes as a table: places in the map frame, m. A vanished pole has its place in x, y; the
/// last three columns are empty unless the pole moved.
void writeCsv(const MapDiff& diff, const std::filesystem::path& file) {
  io::AtomicFile output(file);
  output.stream() << "change,x,y,x_before,y_before,distance\n";
  for (const MapPole& pole : diff.appeared)
    output.stream() << "new," << place(pole, ",") << ",,,\n";
  for (const MapPole& pole : diff.vanished)
    output.stream() << "vanished," << place(pole, ",") << ",,,\n";
  for (const MapDiff::Pair& pair : diff.moved)
    output.stream() << "moved," << place(pair.after, ",") << ',' << place(pair.before, ",") << ','
                    << io::fixed(pair.distance, 3) << '\n';
  output.commit();
}

/// One line a change, then the counts.
std::string summaryText(const MapDiff& diff) {
  std::ostringstream out;
  for (const MapPole& pole : diff.appeared) out << "new       " << place(pole, " ") << '\n';
  for (const MapPole& pole : diff.vanished) out << "vanished  " << place(pole, " ") << '\n';
  for (const MapDiff::Pair& pair : diff.moved)
    out << "moved     " << place(pair.before, " ") << " -> " << place(pair.after, " ") << " ("
        << io::fixed(pair.distance, 2) << " m)\n";
  out << diff.appeared.size() << " new, " << diff.vanished.size() << " vanished, "
      << diff.moved.size() << " moved, " << diff.same.size() << " the same\n";
  return out.str();
}

/// What `diff` takes.
struct DiffLine {
  std::filesystem::path before, after;
  std::optional<std::filesystem::path> csv, png, scene;
  std::string config;
  std::vector<std::string> set;
};

std::string diffMapFiles(const DiffLine& line) {
  const MapUpdateOptions options =
      line.config.empty() ? MapUpdateOptions() : loadSettings(line.config, line.set).upkeep;
  const auto mapBefore = io::readPoleMap(line.before), mapAfter = io::readPoleMap(line.after);
  io::requireSameDatum({line.before.string(), mapBefore.info},
                       {line.after.string(), mapAfter.info});
  const MapDiff diff = diffMaps(mapBefore.poles, mapAfter.poles, {options.moved});
  const std::string before = line.before.filename().string(),
                    after = line.after.filename().string();
  io::AtomicFiles files;
  if (line.csv) writeCsv(diff, *line.csv);
  if (line.png) report::drawDiffPng(diff, before + " → " + after, *line.png);
  if (line.scene) scene::save(*report::makeDiffScene(diff, before + " to " + after), *line.scene);
  files.commit();
  return summaryText(diff);
}

Subcommand diffCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand("diff", "Lists and draws what changed between two maps");
  const auto line = std::make_shared<DiffLine>();
  addFile(cli, "before", line->before, "Map of the earlier day, .polemap")->required();
  addFile(cli, "after", line->after, "Map of the later day, .polemap")->required();
  addConfigOption(cli, line->config, " ([map_update] moved_m)");
  addSetOption(cli, line->set);
  cli.get_option("--set")->needs("--config");
  addOutput(cli, "--scene", line->scene, "Also write a .3Dscene of the changes");
  addOutput(cli, "--csv", line->csv, "Also write the changes to this table");
  addOutput(cli, "--png", line->png, "Also draw the changes");
  return {&cli, [line](bool) { return diffMapFiles(*line); }};
}

/// From `.polemap` to `.polemap` everything is kept, so that a datum can be set. \param datum
/// Needed when the input has none; otherwise both must agree. \return What the program prints.
std::string convertMap(const std::filesystem::path& input, const std::filesystem::path& output,
                       const std::optional<io::Datum>& datum) {
  const MapFileKind written = mapFileKind(output);  // before anything is read
  MapContent content = readMapFile(input, datum);
  io::PoleMapData& map = content.map;
  if (map.poles.empty()) throw Error(input.string() + ": no pole in it");
  if (datum) io::setDatum(map.info, *datum, input.string() + ": ");
  if (map.info.count("program") == 0) {
    map.info["program"] = std::string("pole-map ") + version();
    map.info["build"] = buildIdentity();
    map.info["converted_from"] = input.filename().string();
  }
  writeMapFile(output, content);
  std::ostringstream out;
  out << output.string() << ": " << map.poles.size() << " poles\n";
  if (content.otherFeatures > 0)
    out << "features that are no points, left out: " << content.otherFeatures << '\n';
  if (written != MapFileKind::polemap && !map.candidates.empty())
    out << "candidates, which are not on the map, left out: " << map.candidates.size() << '\n';
  return out.str();
}

Subcommand convertCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand(
      "convert", "Converts a map; endings name the kinds: .polemap, .csv, .geojson; .npz as input");
  struct Line {
    std::filesystem::path input, output;
    std::string datum;
  };
  const auto line = std::make_shared<Line>();
  addFile(cli, "input", line->input, "Map to read")->required();
  addOutput(cli, "--output", line->output, "Map to write")->required();
  addDatumOption(cli, line->datum, "the map");
  return {&cli,
          [line](bool) { return convertMap(line->input, line->output, datumOf(line->datum)); }};
}

Subcommand importCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand(
      "import", "A map from an inventory: .csv, .geojson, or .osm of OpenStreetMap or Lanelet2");
  const auto options = std::make_shared<MapImportOptions>();
  const auto datum = std::make_shared<std::string>();
  addFile(cli, "--input", options->input, "Inventory to read")->required();
  addOutput(cli, "--output", options->output, "Map to write, .polemap")->required();
  cli.add_option("--crs", options->coordinates, "Coordinate system of the places, as EPSG:25833")
      ->capture_default_str();
  cli.add_option("--columns", options->columns, "CSV: columns of the place, east before north")
      ->type_name("EAST,NORTH")
      ->delimiter(',')
      ->expected(2);
  cli.add_option("--separator", options->separator, "CSV: character between fields")
      ->capture_default_str();
  cli.add_option(
         "--keep", options->keep,
         "Keep entries with this property; several: with any of them. OSM: kind=lamp, pole, "
         "tree, sign, light, bollard")
      ->type_name("NAME=VALUE")
      ->check([](const std::string& text) {
        return text.find('=') == std::string::npos ? "NAME=VALUE expected, not " + text
                                                   : std::string();
      });
  cli.add_option("--radius-property", options->radiusProperty,
                 "Column or property of the radius; without it, radii are unknown");
  addNumber(cli, "--radius-unit", options->radiusUnit,
            "Length of a unit of that column or property, m", positiveNumber());
  addNumber(cli, "--sigma-m", options->sigma, "Standard deviation of the places along an axis, m",
            positiveNumber());
  addNumber(cli, "--merge-m", options->merge, "Entries this near to an earlier one are left out, m",
            CLI::NonNegativeNumber);
  addDatumOption(cli, *datum, "the map (the middle of the poles)");
  return {&cli, [options, datum](bool) {
            options->datum = datumOf(*datum);
            return summaryText(importMap(*options), *options);
          }};
}

/// By subcommand; the first one is that of the program.
const Guides kMapGuides{
    {"",
     {{"pole-map build --config demo.ini --input monday.rawlog --truth monday.tum --output "
       "street.polemap",
       "pole-map convert street.polemap --output street.csv"},
      "See the options of one subcommand, such as pole-map build --help."}},
    {"build",
     {{"pole-map build --config demo.ini --input monday.rawlog --truth monday.tum --output "
       "street.polemap",
       "pole-map build --config demo.ini --input monday.rawlog tuesday.rawlog --truth monday.tum "
       "tuesday.tum --output both.polemap --keep-scans --scene both.3Dscene",
       "pole-map build --config demo.ini --input tuesday.rawlog --estimate out/run_00.tum "
       "--inventory street.polemap --output exact.polemap"},
      "Localize another drive in the map: pole-localize --help. Where the true poles are known, "
      "score the map: pole-eval map --help."}},
    {"update",
     {{"pole-map update --config demo.ini --map street.polemap --input tuesday.rawlog --truth "
       "tuesday.tum --output tuesday.polemap --date 2026-03-06"},
      "List what changed: pole-map diff street.polemap tuesday.polemap --png changes.png."}},
    {"diff",
     {{"pole-map diff street.polemap tuesday.polemap --png changes.png --csv changes.csv"},
      "Open a scene written with --scene in MRPT's SceneViewer3D."}},
    {"convert",
     {{"pole-map convert street.polemap --output street.csv",
       "pole-map convert street.polemap --output street.geojson --datum 52.5,13.4,90"},
      "Tables open in a spreadsheet, .npz in NumPy, .geojson in QGIS."}},
    {"import",
     {{"pole-map import --input district.osm --keep kind=lamp kind=tree --sigma-m 1 --output "
       "city.polemap",
       "pole-map import --input trees.csv --separator ';' --columns Rechtswert,Hochwert --crs "
       "EPSG:25833 --output city.polemap"},
      "Localize a drive in it, and make it exact: pole-map build --inventory."}},
};

}  // namespace

int mapMain(int argc, const char* const* argv) {
  CommandLine line("pole-map",
                   "Builds a pole map from scans, or poles, at known poses; updates it; compares "
                   "two; converts them; imports inventories.",
                   kMapGuides);
  CLI::App& cli = line.cli();
  return line.run(argc, argv,
                  {buildCommand(cli), updateCommand(cli), diffCommand(cli), convertCommand(cli),
                   importCommand(cli)});
}

}  // namespace polemcl::apps
