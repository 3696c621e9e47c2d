#include "map/MapUpdateApp.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "cli/JsonFile.h"
#include "cli/Version.h"
#include "core/common/Angles.h"
#include "io/file/AtomicFile.h"
#include "io/file/Date.h"
#include "io/file/TextFile.h"
#include "io/map/PoleMapFile.h"

namespace polemcl::apps {
namespace {

constexpr std::size_t kEnoughExpected = 10;  ///< poles; fewer tell nothing of the place
constexpr double kLeastFound = 0.2;          ///< share; half a map does not vanish over night
constexpr double kManyMoved = 0.05;          ///< share of the poles in view; more is suspicious

void requireSamePlace(const MapUpdateCounts& counts, const std::filesystem::path& input,
                      const std::filesystem::path& map) {
  const bool near = counts.nearOnMap > counts.expectedOnMap;
  const std::size_t expected = near ? counts.nearOnMap : counts.expectedOnMap;
  if (expected < kEnoughExpected ||
      static_cast<double>(counts.foundOnMap) >= kLeastFound * static_cast<double>(expected))
    return;
  throw Error(input.string() + ": only " + std::to_string(counts.foundOnMap) + " of " +
              std::to_string(expected) + " poles of " + map.string() +
              (near ? " near its path" : " in its view") +
              " were found; are its poses of the same place and datum? A new place "
              "needs a new map, a map of pole-map import needs pole-map build --inventory");
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
void requireNearby(const std::vector<StampedPose2D>& path, const LandmarkMap& map,
                   const std::filesystem::path& input, const std::filesystem::path& file) {
  constexpr double kFarthest = 10000;  // m
  Eigen::AlignedBox2d driven, mapped;
  for (const auto& [time, pose] : path) driven.extend(Eigen::Vector2d(pose.x, pose.y));
  for (const LandmarkRecord& kept : map.poles)
    mapped.extend(Eigen::Vector2d(kept.pole.x, kept.pole.y));
  if (mapped.isEmpty() || driven.exteriorDistance(mapped) <= kFarthest) return;
  throw Error(input.string() + ": its poses are " +
              std::to_string(std::lround(driven.exteriorDistance(mapped) / 1000)) +
              " km from the poles of " + file.string() +
              " (10 km are allowed): do they share a datum?");
}

/// \throws Error when the map keeps scans and would be replaced by one that has none.
io::PoleMapData readMap(const MapUpdateJob& job) {
  std::optional<AddedSessions> scans;
  io::PoleMapData map = io::readPoleMap(job.map, &scans);
  std::error_code none;
  if (scans && std::filesystem::equivalent(job.map, job.output, none))
    throw Error(job.output.string() +
                ": keeps the scans it was made of, which an updated map does not have; give "
                "another --output");
  return map;
}

const char* name(PoseKind kind) {
  return kind == PoseKind::truth ? "truth" : "estimate";
}

std::map<std::string, std::string> updateFacts(std::map<std::string, std::string> info,
                                               const MapUpdateJob& job,
                                               const AllSettings& settings) {
  std::string& updates = info["updates"];
  for (const auto& input : job.inputs)
    updates += (updates.empty() ? "" : " ") + input.filename().string();
  for (const auto& input : job.inputs) {
    info["f_map." + input.stem().string()] = io::fixed(1, 6);
    info["poses." + input.stem().string()] = name(job.kind);
  }
  if (job.datum) io::setDatum(info, *job.datum, job.map.string() + ": ");
  info["program"] = std::string("pole-map ") + version();
  info["build"] = buildIdentity();
  info["config"] = settingsText(settings);
  return info;
}

double movedShare(const MapUpdateCounts& c) {
  return c.expectedOnMap > 0 ? static_cast<double>(c.moved) / static_cast<double>(c.expectedOnMap)
                             : 0;
}

Json sessionJson(const MapUpdateCounts& c) {
  return {{"scans", c.scans},
          {"uncertain", c.uncertain},
          {"expected", c.expectedOnMap},
          {"near", c.nearOnMap},
          {"found", c.foundOnMap},
          {"new", c.entered},
          {"vanished", c.left},
          {"moved", c.moved},
          {"moved_share", movedShare(c)},
          {"candidates", c.candidates},
          {"aligned_scans", c.alignment.scans},
          {"shift_mean_m", c.alignment.meanShift},
          {"shift_max_m", c.alignment.largestShift},
          {"turn_max_deg", c.alignment.largestTurn / degree}};
}

Json summaryJson(const MapUpdateSummary& summary, const MapUpdateJob& job) {
  Json json{{"map", job.output.string()}, {"poles", summary.poles}, {"before", summary.before}};
  json["not_ok"] = summary.skipped.notOk;
  json["unmatched"] = summary.skipped.unmatched;
  json["sessions"] = Json::array();
  for (std::size_t i = 0; i < summary.sessions.size(); ++i) {
    Json session{{"input", job.inputs[i].string()}, {"poses", name(job.kind)}};
    session.update(sessionJson(summary.sessions[i]));
    json["sessions"].push_back(session);
  }
  json["warnings"] = warningsOf(summary, job);
  return json;
}

}  // namespace

MapUpdateSummary updateMapFile(const MapUpdateJob& job, const AllSettings& settings,
                               const ScanProgress& progress) {
  job.validate();
  const io::PoleMapData before = readMap(job);
  auto info = updateFacts(before.info, job, settings);
  MapUpdateSummary summary;
  summary.before = before.poles.size();
  LandmarkMap map = io::landmarkMap(before);
  std::vector<StampedPose2D> path;
  for (std::size_t i = 0; i < job.inputs.size(); ++i) {
    MappingSession session =
        loadMappingSession(job.session(i), settings, job.allowTruncated, progress);
    requireNearby(session.path, map, job.inputs[i], job.map);
    if (!job.dates.empty()) setDate(session.scans, job.dates[i]);
    requireDateOrder(session.scans, map, job.inputs[i], job.map);
    MapUpdateCounts counts;
    map = updateMap(map, session.scans, settings.map, settings.upkeep, &counts);
    if (counts.scans == 0)
      throw Error(job.inputs[i].string() + ": no usable scan, all " +
                  std::to_string(counts.uncertain) +
                  " poses have a standard deviation above 0.25 m");
    requireSamePlace(counts, job.inputs[i], job.map);
    summary.sessions.push_back(counts);
    summary.skipped += session.skipped;
    for (const std::string& doubt : session.turnDoubts)
      summary.doubts.push_back(job.inputs[i].string() + ": " + doubt);
    path.insert(path.end(), session.path.begin(), session.path.end());
  }
  keepWarnings(warningsOf(summary, job), info);
  const io::PoleMapData after = io::mapData(map, info);
  summary.poles = after.poles.size();
  if (after.poles.empty())
    throw Error(job.map.string() + ": no pole is left on the map; see [map_update]");
  io::AtomicFiles files;
  writeViews(job, after, {job.output.filename().string(), after.poles, path, {}});
  if (job.json) writeJson(*job.json, summaryJson(summary, job));
  io::writePoleMap(job.output, after);
  files.commit();
  return summary;
}

std::vector<std::string> warningsOf(const MapUpdateSummary& summary, const MapUpdateJob& job) {
  std::vector<std::string> warnings = summary.doubts;
  for (std::size_t i = 0; i < summary.sessions.size(); ++i) {
    const MapUpdateCounts& c = summary.sessions[i];
    if (!(movedShare(c) > kManyMoved)) continue;
    std::ostringstream line;
    line << job.inputs[i].string() << ": " << c.moved << " of " << c.expectedOnMap
         << " poles in view (" << io::fixed(100 * movedShare(c), 1)
         << " %) seem to have moved; poles seldom do, check " << job.poses[i].string();
    warnings.push_back(line.str());
  }
  return warnings;
}

std::string summaryText(const MapUpdateSummary& summary, const MapUpdateJob& job) {
  std::ostringstream out;
  out << job.output.string() << ": " << summary.poles << " poles, " << summary.before
      << " before\n";
  for (std::size_t i = 0; i < summary.sessions.size(); ++i) {
    const MapUpdateCounts& c = summary.sessions[i];
    out << job.inputs[i].string() << ": " << c.scans << " scans; of " << c.expectedOnMap
        << " poles in view " << c.foundOnMap << " found; " << c.entered << " new, " << c.left
        << " vanished, " << c.moved << " moved; " << c.candidates << " candidates\n";
    if (c.uncertain > 0)
      out << "scans with too uncertain a pose, not used: " << c.uncertain << '\n';
    if (c.alignment.scans > 0)
      out << "aligned to the map: " << c.alignment.scans << " scans, by "
          << io::fixed(c.alignment.meanShift, 3) << " m on average, at most "
          << io::fixed(c.alignment.largestShift, 3) << " m and "
          << io::fixed(c.alignment.largestTurn / degree, 2) << " deg\n";
    if (c.withoutVisibility > 0)
      out << "scans without visibility ranges, in which nothing counts as missed: "
          << c.withoutVisibility << '\n';
  }
  out << summary.skipped;
  return out.str();
}

}  // namespace polemcl::apps
