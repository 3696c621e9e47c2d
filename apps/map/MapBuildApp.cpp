#include "map/MapBuildApp.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/common/KdTree2D.h"
#include "core/common/Transform.h"
#include "io/file/AtomicFile.h"
#include "io/file/ErrorPlace.h"
#include "io/map/PoleMapFile.h"
#include "map/DriveFixFiles.h"
#include "map/DrivePoses.h"
#include "map/MapBuildReport.h"
#include "map/TimingDoubt.h"
#include "report/picture/Pictures.h"

namespace polemcl::apps {
namespace {

namespace fs = std::filesystem;

constexpr double kTwin = 1;  ///< m; real poles seldom stand nearer to each other

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

/// Whether a scan was read twice. Its poles may have been corrected for other motions.
bool isSame(const SessionScan& a, const SessionScan& b) {
  constexpr double near = 0.1;  // m
  if (a.time != b.time || a.poles_robot.size() != b.poles_robot.size()) return false;
  if (a.poles_robot.empty()) return true;
  const PoleDetection &first = a.poles_robot[0], &other = b.poles_robot[0];
  return std::hypot(first.x - other.x, first.y - other.y) < near;
}

/// \throws Error when a drive is one of those before: its poles would count twice.
void requireNew(const std::filesystem::path& input, const std::vector<SessionScan>& scans,
                const AddedSessions& before) {
  for (const AddedSession& session : before.sessions)
    if (session.usedCount() == session.scans.size() &&
        std::equal(scans.begin(), scans.end(), session.scans.begin(), session.scans.end(), isSame))
      throw Error(input.string() + ": all its scans are those of the session " + session.name +
                  ", which is in the map already; leave it out");
}

/// \param covariances Of the poses, when they were found without truth; else empty.
void addDrive(const MapBuildJob& job, std::size_t drive, MappingSession found,
              std::vector<Eigen::Matrix3d> covariances, MapAccumulator& sessions,
              MapBuildSummary& summary) {
  if (!job.dates.empty()) setDate(found.scans, job.dates[drive]);
  requireNew(job.inputs[drive], found.scans, sessions.added());
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
  paths.reserve(drives.size());
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
  const bool placed = std::any_of(mapped.fixes.begin(), mapped.fixes.end(),
                                  [](const FixFit& fit) { return fit.given > 0; });
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

/// A doubt about one drive for the warnings, if there is any.
void doubt(MapBuildSummary& summary, const MapBuildJob& job, std::size_t drive,
           const std::string& text) {
  if (!text.empty()) summary.doubts.push_back(job.inputs[drive].filename().string() + ": " + text);
}

/// The poses of the drives, and whether their poles doubt the timing or the mounting.
void mapDrivesOf(std::vector<MappingSession>& drives, const MapBuildJob& job,
                 const AddedSessions& before, std::optional<io::Datum>& datum,
                 const AllSettings& settings, MapBuildSummary& summary) {
  const ScanTiming& timing = settings.sensor.timing;
  std::vector<TimingEstimate> dead;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    summary.filled.push_back(drives[i].filled);
    dead.push_back(remainingTiming(drives[i], timing.seconds));
    doubt(summary, job, i, checkMotion(drives[i].scans).mountingDoubt());
  }
  summary.mapped = findPosesOf(drives, job, before, datum, settings, summary.fixesApart);
  for (std::size_t i = 0; i < drives.size(); ++i)
    doubt(summary, job, i,
          timingDoubt(dead[i], remainingTiming(drives[i], timing.seconds), timing,
                      drives[i].looksRaw));
}

/// Whether the poles contradict the true poses, the timing of the scans or the mounting.
void checkTruth(const std::vector<MappingSession>& drives, const MapBuildJob& job,
                const ScanTiming& timing, MapBuildSummary& summary) {
  for (std::size_t i = 0; i < drives.size(); ++i) {
    summary.motions.push_back(checkMotion(drives[i].scans));
    doubt(summary, job, i, timingDoubtOfTruth(drives[i], timing));
    doubt(summary, job, i, summary.motions.back().mountingDoubt());
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
  for (std::size_t i = 0; i < drives.size(); ++i)
    for (const std::string& text : drives[i].turnDoubts) doubt(summary, job, i, text);
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
  summary.mapping = settings.map;
  summary.map = sessions.build();
  if (summary.map.poles.empty()) throw Error(noPolesText(summary));
  summary.twins = countTwins(summary.map.poles);

  LandmarkMap landmarks = sessions.withHistories(summary.map.poles);
  if (summary.inventory) {
    const auto kept = outOfSight(inventory, summary.inventory->drives, settings.upkeep.range);
    summary.inventory->kept = kept.size();
    landmarks.poles.insert(landmarks.poles.end(), kept.begin(), kept.end());
  }
  const io::PoleMapData map =
      io::mapData(landmarks, mapFacts(settings, summary, job, datum, base.map.info));
  io::AtomicFiles files;
  if (summary.mapped) writeTrajectories(job, *summary.mapped, paths);
  const report::MapView view = viewOf(job, summary, map, pathOf(sessions.added()));
  writeViews(job, map, view);
  if (job.png) report::drawMapPng(view, *job.png);
  io::writePoleMap(job.output, map, job.keepScans || job.add ? &sessions.added() : nullptr);
  files.commit();
  return summary;
}

}  // namespace polemcl::apps
