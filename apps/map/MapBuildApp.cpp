#include "map/MapBuildApp.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "cli/Version.h"
#include "core/common/KdTree2D.h"
#include "core/common/Transform.h"
#include "io/file/AtomicFile.h"
#include "io/file/ErrorPlace.h"
#include "io/file/TextFile.h"
#include "io/map/PoleMapFile.h"
#include "map/DriveDoubts.h"
#include "map/DriveFixFiles.h"
#include "map/DrivePoses.h"
#include "map/TimingDoubt.h"
#include "report/picture/MapPicture.h"

namespace polemcl::apps {
namespace {

namespace fs = std::filesystem;

constexpr double kTwin = 1;          ///< m; real poles seldom stand nearer to each other
constexpr double kManyTwins = 0.25;  ///< share of the poles

/// The map that is added to, or the inventory.
struct BaseMap {
  std::filesystem::path file;  ///< empty: there is no such map
  io::PoleMapData map = {};
  std::optional<AddedSessions> scans = {};
};

BaseMap baseOf(const MapBuildJob& job) {
  BaseMap base{job.add ? *job.add : job.inventory.value_or("")};
  if (!base.file.empty()) base.map = io::readPoleMap(base.file, &base.scans);
  return base;
}

/// The sessions before; empty unless `add` is given.
MapAccumulator accumulator(const MapBuildJob& job, BaseMap& base, const AllSettings& settings) {
  if (!job.add) return {settings.map, settings.upkeep};
  if (!base.scans)
    throw Error(job.add->string() +
                ": keeps no scans, so none can be added; build it with --keep-scans");
  if (base.map.info.count("pose_sigma_m") > 0)
    throw Error(job.add->string() +
                ": was made with --inventory; its poles out of sight would be lost, so none can be "
                "added: build one map of all drives");
  return io::located(job.add->string() + ": ", [&] {
    return MapAccumulator(settings.map, settings.upkeep, std::move(*base.scans));
  });
}

/// The job's datum, or that of the map that is added to, or of the inventory: both must be the
/// same.
std::optional<io::Datum> datumFor(const MapBuildJob& job, const BaseMap& base) {
  if (base.file.empty()) return job.datum;
  const std::string where = base.file.string() + ": ";
  auto info = base.map.info;
  if (job.datum) io::setDatum(info, *job.datum, where);
  return io::datumOf(info, where);
}

/// The poles of an inventory that no drive saw, and that no scan came nearer to than a range.
std::vector<LandmarkRecord> outOfSight(const LandmarkMap& inventory, const AdjustedDrives& drives,
                                       double range) {
  const KdTree2D path(centresOf(drives.poses_map_robot));
  const std::set<std::size_t> seen(drives.anchors.begin(), drives.anchors.end());
  std::vector<LandmarkRecord> left;
  std::size_t number = 0;  // among those on the map
  for (const LandmarkRecord& pole : inventory.poles)
    if (pole.present && seen.count(number++) == 0 && !path.nearest(pole.pole.x, pole.pole.y, range))
      left.push_back(pole);
  return left;
}

/// \param covariances Of the poses, when they were found without truth; else empty.
void addDrive(const MapBuildJob& job, std::size_t drive, MappingSession found,
              std::vector<Eigen::Matrix3d> covariances, MapAccumulator& sessions,
              MapBuildSummary& summary) {
  if (!job.dates.empty()) setDate(found.scans, job.dates[drive]);
  sessions.add(job.inputs[drive].filename().string(), std::move(found.scans),
               std::move(covariances));
  summary.skipped += found.skipped;
}

void addDrives(const MapBuildJob& job, std::vector<MappingSession> drives, MapAccumulator& sessions,
               MapBuildSummary& summary) {
  std::size_t next = summary.mapped ? summary.mapped->known : 0;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    std::vector<Eigen::Matrix3d> covariances;
    for (std::size_t k = 0; summary.mapped && k < drives[i].scans.size(); ++k)
      covariances.push_back(summary.mapped->poses.at(next++).covariance);
    addDrive(job, i, std::move(drives[i]), std::move(covariances), sessions, summary);
  }
}

void countSessions(const AddedSessions& added, MapBuildSummary& summary) {
  for (const AddedSession& session : added.sessions) {
    summary.sessions.push_back(
        {session.name, session.scans.size(), session.usedCount(), session.usedShare()});
    summary.visited += session.scans.size();
    summary.scans += session.usedCount();
  }
}

std::vector<DrivenPath> pathsOf(const std::vector<MappingSession>& drives) {
  std::vector<DrivenPath> paths;
  for (const MappingSession& drive : drives) paths.push_back({drive.path, drive.numbers});
  return paths;
}

std::vector<StampedPose2D> pathOf(const AddedSessions& added) {
  std::vector<StampedPose2D> path;
  for (const AddedSession& session : added.sessions)
    for (const SessionScan& scan : session.scans) path.push_back({scan.time, scan.pose_map_robot});
  return path;
}

void writeTrajectories(const MapBuildJob& job, const MappedDrives& mapped,
                       const std::vector<DrivenPath>& paths) {
  for (std::size_t i = 0, first = mapped.known; i < job.trajectories.size();
       first += paths[i++].poses.size())
    writeTrajectory(job.trajectories[i], paths[i], mapped.poses, first);
}

report::MapView viewOf(const MapBuildJob& job, const MapBuildSummary& summary,
                       const io::PoleMapData& map, const std::vector<StampedPose2D>& path) {
  report::MapView view;
  view.title = job.output.filename().string();
  view.poles = map.poles;
  (job.kind == PoseKind::truth ? view.truth : view.estimate) = path;
  if (!summary.mapped) return view;
  for (const ClosedLoop& loop : summary.mapped->loops)
    view.loops.push_back({centreOf(summary.mapped->poses[loop.first].mean),
                          centreOf(summary.mapped->poses[loop.second].mean)});
  return view;
}

std::size_t countTwins(const std::vector<MapPole>& poles) {
  const KdTree2D tree(centresOf(poles));
  std::size_t twins = 0;
  std::vector<PointHit> hits;  // the pole itself is one
  for (const MapPole& pole : poles) {
    tree.within(pole.x, pole.y, kTwin, hits);
    twins += hits.size() > 1;
  }
  return twins;
}

double scanSpacing(const MapBuildSummary& summary) {
  const std::size_t steps = summary.visited - std::min(summary.visited, summary.sessions.size());
  return steps > 0 ? summary.map.pathLength / static_cast<double>(steps) : 0;
}

const char* counted(PoleCounting counting) {
  switch (counting) {
    case PoleCounting::members:
      return " detections";
    case PoleCounting::confidences:
      return " sections of one run, weighed by confidence";
    case PoleCounting::run:
      return " sections of one run";
  }
  return "";
}

std::string noPoles(const MapBuildSummary& summary, const PoleMapOptions& options) {
  const auto& map = summary.map;
  return "no pole found: " + std::to_string(summary.scans) + " scans " +
         io::fixed(scanSpacing(summary), 2) +
         " m apart on average; sections of section_length_m = " +
         io::significant(options.sectionLength, 6) + ", " + std::to_string(map.occupiedSections) +
         " of " + std::to_string(map.sections) + " with a scan; " + std::to_string(map.detections) +
         " detections in " + std::to_string(map.clusters) + " places, the best with " +
         io::significant(map.bestCount, 4) + counted(options.counting) +
         ", min_count = " + io::significant(options.minCount, 4) +
         " are needed (less where scans are far apart)" +
         (map.detections == 0 ? "; see [sensor] and [extraction]" : "; see [map]") +
         // Poles that are found again and again fall into few places.
         (map.detections > 0 && 2 * map.clusters > map.detections
              ? "; most places hold one detection: check that the true poses fit the scans (frame, "
                "z up, times)"
              : "");
}

/// `f_map.NAME` of each session; of equal names the second is `f_map.NAME.2`.
void addShares(const MapBuildSummary& summary, std::map<std::string, std::string>& info) {
  for (const MapBuildSummary::Session& session : summary.sessions) {
    const std::string key = "f_map." + std::filesystem::path(session.name).stem().string();
    std::string unique = key;
    for (int n = 2; info.count(unique) > 0; ++n) unique = key + '.' + std::to_string(n);
    info[unique] = io::fixed(session.share, 6);
  }
}

/// A count in the info of a map; 0 where it has no such key.
double countIn(const std::map<std::string, std::string>& info, const std::string& key) {
  const auto fact = info.find(key);
  return fact == info.end() ? 0 : io::parseNumber(fact->second).value_or(0);
}

/// Positions from satellites of all drives; their distance is not summed up.
FixFit allFixes(const MappedDrives& mapped) {
  FixFit sum;
  for (const FixFit& fit : mapped.fixes) {
    sum.given += fit.given;
    sum.fitting += fit.fitting;
  }
  return sum;
}

std::map<std::string, std::string> facts(const AllSettings& settings,
                                         const MapBuildSummary& summary, const MapBuildJob& job,
                                         const std::optional<io::Datum>& datum,
                                         const std::map<std::string, std::string>& before) {
  std::string names;
  for (const MapBuildSummary::Session& session : summary.sessions)
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
  if (const auto earlier = before.find("warnings"); job.add && earlier != before.end())
    info.insert(*earlier);
  if (datum) info[io::kDatumKey] = io::datumText(*datum);
  keepWarnings(buildWarnings(summary, job), info);
  if (summary.mapped) {
    info["poses"] = "odometry";
    info["loops"] = std::to_string(summary.mapped->newLoops());
    if (const std::size_t used = allFixes(*summary.mapped).fitting; used > 0)
      info["fixes"] = std::to_string(used);
  }
  if (summary.inventory) info["pose_sigma_m"] = io::fixed(summary.inventory->drives.sigma, 4);
  if (!job.add) return info;
  if (before.count("poses") > 0) info["poses"] = before.at("poses");
  for (const char* key : {"loops", "fixes"}) {
    const double sum = countIn(info, key) + countIn(before, key);
    if (sum > 0) info[key] = io::fixed(sum, 0);
  }
  return info;
}

/// Standard deviation of a place along an axis, m.
double sigmaOf(const PoseWithCovariance& pose) {
  return std::sqrt(pose.covariance.topLeftCorner<2, 2>().trace() / 2);
}

std::string foundText(const MapBuildSummary& summary, const MapBuildJob& job) {
  const MappedDrives& mapped = *summary.mapped;
  const FixFit fixes = allFixes(mapped);
  std::ostringstream out;
  const bool alone = std::all_of(summary.filled.begin(), summary.filled.end(),
                                 [](const FilledMotions& filled) { return filled.all; });
  out << (alone ? "poses by " : "poses by odometry and ") << mapped.tracks
      << " poles followed over " << io::fixed(mapped.driven, 1) << " m; " << mapped.newLoops()
      << " places passed again; the last pose is certain to "
      << io::fixed(sigmaOf(mapped.poses.back()), 2)
      << (fixes.given + mapped.known > 0 ? " m\n" : " m against the first\n");
  if (fixes.given > 0)
    out << "placed by " << fixes.fitting
        << " positions from satellites; the first pose is certain to "
        << io::fixed(sigmaOf(mapped.poses.at(mapped.known)), 2) << " m\n";
  for (std::size_t i = 0; i < mapped.odometry.size(); ++i) {
    const FilledMotions& filled = summary.filled[i];
    const std::size_t missing = filled.byPoles + filled.coasted;
    const std::string drive = job.inputs[i].filename().string();
    if (mapped.fixes[i].given > 0)
      out << drive << ": its " << mapped.fixes[i].given << " positions from satellites lie "
          << io::fixed(mapped.fixes[i].distance, 2) << " m from its path (median), "
          << mapped.fixes[i].given - mapped.fixes[i].fitting << " of them do not fit\n";
    if (i < summary.fixesApart.size() && summary.fixesApart[i] > 0)
      out << drive << ": left out " << summary.fixesApart[i]
          << " positions from satellites between scans more than 2 s and 10 m apart\n";
    if (missing > 0)
      out << drive << ": no odometry leads to " << missing << " scans; the poles told the way to "
          << filled.byPoles
          << (filled.coasted > 0 ? ", the others go on as before: look there\n" : "\n");
    if (filled.all) continue;
    out << drive << ": its odometry is " << io::fixed(-100 * mapped.odometry[i].x(), 2)
        << " % long, and turns " << io::fixed(-mapped.odometry[i].y() * 180 / M_PI, 4)
        << " deg/m\n";
  }
  return out.str();
}

/// The datum becomes that of the fixes, where these place the map. Fixes that merely lie in a
/// rawlog may be of no use; a table of them must not.
MappedDrives findPosesOf(std::vector<MappingSession>& drives, const MapBuildJob& job,
                         const AddedSessions& before, std::optional<io::Datum>& datum,
                         const AllSettings& settings, std::vector<std::size_t>& fixesApart) {
  const bool usable = !job.add || datum;
  if (!usable && !job.gnss.empty())
    throw Error(job.add->string() +
                ": has no datum, so that fixes cannot be placed on it; leave out --gnss");
  auto plane = datum;
  ReadFixes read = usable ? readDriveFixes(job, drives, before.scans(), plane) : ReadFixes();
  fixesApart = std::move(read.apart);
  MappedDrives mapped = findPoses(drives, job.inputs, before, std::move(read.fixes), settings);
  const bool placed = allFixes(mapped).given > 0;
  if (placed) datum = plane;
  if (!job.gnss.empty() && !placed)
    throw Error(job.gnss.front().string() +
                ": its fixes are too few, or too near to each other, to place a drive: five are "
                "needed, over 40 m; leave out --gnss");
  // The frame is that of the first scan: a datum would place it elsewhere on Earth.
  if (job.datum && !job.add && !placed)
    throw Error("--datum " + io::datumText(*job.datum) +
                ": no drive has five positions from satellites over 40 m, which place the map "
                "there; give --gnss or --truth, or leave out --datum");
  return mapped;
}

/// The poses of the drives, and whether their poles doubt the timing.
void mapDrivesOf(std::vector<MappingSession>& drives, const MapBuildJob& job,
                 const AddedSessions& before, std::optional<io::Datum>& datum,
                 const AllSettings& settings, MapBuildSummary& summary) {
  const ScanTiming& timing = settings.sensor.timing;
  std::vector<TimingEstimate> dead;
  for (const MappingSession& drive : drives) {
    summary.filled.push_back(drive.filled);
    dead.push_back(remainingTiming(drive, timing.seconds));
  }
  summary.mapped = findPosesOf(drives, job, before, datum, settings, summary.fixesApart);
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const std::string doubt =
        timingDoubt(dead[i], remainingTiming(drives[i], timing.seconds), timing);
    if (!doubt.empty())
      summary.timingDoubts.push_back(job.inputs[i].filename().string() + ": " + doubt);
  }
}

/// Whether the poles contradict the true poses, or the timing of the scans.
void checkTruth(const std::vector<MappingSession>& drives, const MapBuildJob& job,
                const ScanTiming& timing, MapBuildSummary& summary) {
  for (std::size_t i = 0; i < drives.size(); ++i) {
    summary.motions.push_back(checkMotion(drives[i].scans));
    const std::string doubt = timingDoubtOfTruth(drives[i], timing);
    if (!doubt.empty())
      summary.timingDoubts.push_back(job.inputs[i].filename().string() + ": " + doubt);
  }
}

}  // namespace

MapBuildSummary buildMap(const MapBuildJob& job, const AllSettings& settings,
                         const ScanProgress& progress) {
  job.validate();
  if (job.inventory && job.keepScans)
    throw Error("--keep-scans: not with --inventory, whose poles out of sight are of no scan");
  MapBuildSummary summary;
  BaseMap base = baseOf(job);
  auto datum = datumFor(job, base);
  MapAccumulator sessions = accumulator(job, base, settings);
  std::vector<MappingSession> drives;
  for (std::size_t i = 0; i < job.inputs.size(); ++i)
    drives.push_back(loadMappingSession(job.session(i), settings, job.allowTruncated, progress));
  if (job.kind == PoseKind::truth) checkTruth(drives, job, settings.sensor.timing, summary);
  LandmarkMap inventory;
  if (job.inventory) {
    inventory = io::landmarkMap(base.map);
    summary.inventory.emplace();
    summary.inventory->drives = io::located(job.inventory->string() + ": ", [&] {
      return adjustToInventory(drives, job.inputs, presentPoles(inventory), settings);
    });
  }
  if (job.kind == PoseKind::odometry)
    mapDrivesOf(drives, job, sessions.added(), datum, settings, summary);
  const auto paths = pathsOf(drives);
  addDrives(job, std::move(drives), sessions, summary);
  countSessions(sessions.added(), summary);
  summary.map = sessions.build();
  if (summary.map.poles.empty()) throw Error(noPoles(summary, settings.map));
  summary.twins = countTwins(summary.map.poles);

  LandmarkMap landmarks = sessions.withHistories(summary.map.poles);
  if (summary.inventory) {
    const auto kept = outOfSight(inventory, summary.inventory->drives, settings.upkeep.range);
    summary.inventory->kept = kept.size();
    landmarks.poles.insert(landmarks.poles.end(), kept.begin(), kept.end());
  }
  const io::PoleMapData map =
      io::mapData(landmarks, facts(settings, summary, job, datum, base.map.info));
  io::AtomicFiles files;
  if (summary.mapped) writeTrajectories(job, *summary.mapped, paths);
  const report::MapView view = viewOf(job, summary, map, pathOf(sessions.added()));
  writeViews(job, map, view);
  if (job.png) report::drawMapPng(view, *job.png);
  io::writePoleMap(job.output, map, job.keepScans || job.add ? &sessions.added() : nullptr);
  files.commit();
  return summary;
}

std::vector<std::string> buildWarnings(const MapBuildSummary& summary, const MapBuildJob& job) {
  std::vector<std::string> warnings = summary.timingDoubts;
  const auto doubt = [&](std::size_t drive, const std::string& text) {
    if (!text.empty()) warnings.push_back(job.inputs[drive].filename().string() + ": " + text);
  };
  for (std::size_t i = 0; i < summary.filled.size(); ++i)
    doubt(i, odometryDoubt(summary.filled[i]));
  for (std::size_t i = 0; summary.mapped && i < summary.mapped->fixes.size(); ++i)
    doubt(i, fixesDoubt(summary.mapped->fixes[i]));
  for (std::size_t i = 0; i < summary.motions.size(); ++i)
    if (summary.motions[i].contradicts())
      warnings.push_back(job.inputs[i].filename().string() + ": " + summary.motions[i].verdict() +
                         "; check " + job.poses[i].filename().string());
  const std::size_t poles = summary.map.poles.size();
  if (static_cast<double>(summary.twins) > kManyTwins * static_cast<double>(poles))
    warnings.push_back(
        std::to_string(summary.twins) + " of " + std::to_string(poles) +
        " poles have a twin nearer than 1 m (the scans are " + io::fixed(scanSpacing(summary), 2) +
        " m apart); mostly the poses of some scans are wrong" +
        (job.kind == PoseKind::truth
             ? ", check them with pole-eval motion"
             : ", or that of the LiDAR on the vehicle (--sensor-pose of pole-import)"));
  return warnings;
}

std::string summaryText(const MapBuildSummary& summary, const MapBuildJob& job) {
  std::ostringstream out;
  out << job.output.string() << ": " << summary.map.poles.size() << " poles from " << summary.scans
      << " scans over " << io::fixed(summary.map.pathLength, 1) << " m\n"
      << "sections: " << summary.map.occupiedSections << " of " << summary.map.sections
      << " with a scan; detections " << summary.map.detections << " in " << summary.map.clusters
      << " places\n";
  if (summary.sessions.size() > 1)
    for (const MapBuildSummary::Session& session : summary.sessions)
      out << session.name << ": " << session.used << " of " << session.scans
          << " scans used, f_map " << io::fixed(session.share, 4) << '\n';
  for (std::size_t i = 0; i < summary.motions.size(); ++i)
    if (!summary.motions[i].contradicts())  // else it is a warning
      out << job.inputs[i].filename().string() << ": " << summary.motions[i].verdict() << '\n';
  if (summary.inventory) {
    const AdjustedDrives& drives = summary.inventory->drives;
    out << "inventory: " << drives.anchors.size() << " of its poles are among the " << drives.poles
        << " poles seen, " << io::fixed(drives.anchorDistance, 2)
        << " m from them (rms); the poses "
        << "are certain to " << io::fixed(drives.sigma, 3)
        << " m; poles of it out of sight, kept: " << summary.inventory->kept << '\n';
  }
  if (summary.mapped) out << foundText(summary, job);
  out << summary.skipped;
  return out.str();
}

}  // namespace polemcl::apps
