#include "map/MapUpdateApp.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iostream>

#include "cli/Version.h"
#include "io/file/Date.h"
#include "io/file/TextFile.h"
#include "io/map/PoleMapFile.h"
#include "io/map/PolePositions.h"
#include "map/MappingSession.h"
#include "report/scene/MapScene.h"

namespace polemcl::apps {
namespace {

constexpr std::size_t enoughExpected = 10;  ///< poles; fewer tell nothing of the place
constexpr double leastFound = 0.2;          ///< share; half a map does not vanish over night

void requireSamePlace(const MapUpdateCounts& counts, const std::filesystem::path& input,
                      const std::filesystem::path& map) {
  if (counts.expectedOnMap < enoughExpected ||
      static_cast<double>(counts.foundOnMap) >=
          leastFound * static_cast<double>(counts.expectedOnMap))
    return;
  throw Error(input.string() + ": only " + std::to_string(counts.foundOnMap) + " of " +
              std::to_string(counts.expectedOnMap) + " poles of " + map.string() +
              " in its view were found; is its truth of the same place and datum? A new place "
              "needs a new map");
}

/// A map is kept up from day to day. Within a day the order is not looked at: dates tell no more.
void requireDateOrder(const std::vector<SessionScan>& scans, const LandmarkMap& map,
                      const std::filesystem::path& input, const std::filesystem::path& file) {
  double last = 0;
  for (const LandmarkRecord& kept : map.poles) last = std::max(last, kept.history.lastSeen);
  const double now = scans.front().time;
  if (!isDate(now) || !isDate(last) || io::dateText(now) >= io::dateText(last)) return;
  throw Error(input.string() + ": is of " + io::dateText(now) + ", but the last session of " +
              file.string() + " of " + io::dateText(last) +
              ": sessions must come in the order of their days; see --date");
}

/// Sessions of a map lie near it; one in another frame mostly does not.
void requireNearMap(const std::vector<StampedPose2D>& path, const LandmarkMap& map,
                    const std::filesystem::path& input, const std::filesystem::path& file) {
  constexpr double farthest = 10000;  // m
  Eigen::AlignedBox2d driven, mapped;
  for (const auto& [time, pose] : path) driven.extend(Eigen::Vector2d(pose.x, pose.y));
  for (const LandmarkRecord& kept : map.poles)
    mapped.extend(Eigen::Vector2d(kept.pole.x, kept.pole.y));
  if (mapped.isEmpty() || driven.exteriorDistance(mapped) <= farthest) return;
  throw Error(input.string() + ": its poses are " +
              std::to_string(std::lround(driven.exteriorDistance(mapped) / 1000)) +
              " km from the poles of " + file.string() +
              " (10 km are allowed): do they share a datum?");
}

std::map<std::string, std::string> updateFacts(std::map<std::string, std::string> info,
                                               const MapUpdateJob& options,
                                               const Settings& settings) {
  std::string& updates = info["updates"];
  for (const auto& input : options.inputs)
    updates += (updates.empty() ? "" : " ") + input.filename().string();
  for (const auto& input : options.inputs) info["f_map." + input.stem().string()] = io::fixed(1, 6);
  if (options.datum) io::setDatum(info, *options.datum, options.map.string() + ": ");
  info["program"] = std::string("pole-map ") + version();
  info["build"] = buildIdentity();
  info["config"] = settingsText(settings);
  return info;
}

}  // namespace

void MapUpdateJob::validate() const {
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

MapUpdateSummary updateMapFile(const MapUpdateJob& options, const Settings& settings,
                               const ScanProgress& progress) {
  options.validate();
  const io::PoleMapData before = io::readPoleMap(options.map);
  const auto info = updateFacts(before.info, options, settings);
  MapUpdateSummary summary;
  summary.before = before.poles.size();
  LandmarkMap map = io::landmarkMap(before);
  report::MapView view;
  for (std::size_t i = 0; i < options.inputs.size(); ++i) {
    MappingSession survey = loadMappingSession(options.inputs[i], options.truths[i], settings,
                                               options.allowTruncated, progress);
    if (survey.scans.empty())
      throw Error(options.inputs[i].string() + ": no usable scan, " +
                  std::to_string(survey.emptyScans) + " without a valid point");
    requireNearMap(survey.path, map, options.inputs[i], options.map);
    if (!options.dates.empty()) setDate(survey.scans, options.dates[i]);
    requireDateOrder(survey.scans, map, options.inputs[i], options.map);
    MapUpdateCounts counts;
    map = updateMap(map, survey.scans, settings.map, settings.upkeep, &counts);
    requireSamePlace(counts, options.inputs[i], options.map);
    summary.sessions.push_back(counts);
    summary.emptyScans += survey.emptyScans;
    summary.unmatched += survey.unmatched;
    summary.invalidPoints += survey.invalidPoints;
    summary.truncated += survey.truncated;
    view.truth.insert(view.truth.end(), survey.path.begin(), survey.path.end());
  }
  const io::PoleMapData after = io::mapData(map, info);
  summary.poles = after.poles.size();
  if (after.poles.empty())
    throw Error(options.map.string() + ": no pole is left on the map; see [map_update]");
  if (options.csv) io::writePoleCsv(*options.csv, after.poles, after.histories);
  if (options.scene) {
    view.title = options.output.filename().string();
    view.poles = after.poles;
    scene::save(*report::makeMapScene(view), *options.scene);
  }
  io::writePoleMap(options.output, after);
  return summary;
}

void print(const MapUpdateSummary& summary, const MapUpdateJob& options) {
  std::cout << options.output.string() << ": " << summary.poles << " poles, " << summary.before
            << " before\n";
  for (std::size_t i = 0; i < summary.sessions.size(); ++i) {
    const MapUpdateCounts& c = summary.sessions[i];
    std::cout << options.inputs[i].string() << ": " << c.scans << " scans; of " << c.expectedOnMap
              << " poles in view " << c.foundOnMap << " found; " << c.entered << " new, " << c.left
              << " vanished, " << c.moved << " moved; " << c.candidates << " candidates\n";
    if (c.withoutFreeRange > 0)
      std::cout << "scans without free ranges, in which nothing counts as missed: "
                << c.withoutFreeRange << '\n';
  }
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

}  // namespace polemcl::apps
