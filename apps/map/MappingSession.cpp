#include "map/MappingSession.h"

#include <cmath>
#include <ostream>
#include <sstream>

#include "cli/RunRecords.h"
#include "cli/SensorCounts.h"
#include "core/common/PoseInterpolation.h"
#include "core/slam/PoleMotions.h"
#include "io/data/Trajectory.h"
#include "io/file/Date.h"
#include "io/file/ErrorPlace.h"
#include "io/file/TextFile.h"
#include "io/map/PoleTables.h"
#include "report/scene/MapScene.h"

namespace polemcl::apps {

std::string MappingJob::wrongCounts() const {
  const std::string files = std::to_string(inputs.size());
  if (inputs.empty()) return "--input: at least one rawlog is needed";
  if (kind != PoseKind::odometry && inputs.size() != poses.size())
    return std::string(kind == PoseKind::truth ? "--truth" : "--estimate") +
           ": one file per --input is needed, " + files + ", not " + std::to_string(poses.size());
  if (!dates.empty() && dates.size() != inputs.size())
    return "--date: one day per --input is needed, " + files + ", not " +
           std::to_string(dates.size()) + "; or leave it out";
  return {};
}

void MappingJob::validate() const {
  if (const std::string wrong = wrongCounts(); !wrong.empty()) throw Error(wrong);
  if (output.extension() != ".polemap")
    throw Error("--output " + output.string() + ": the name must end in .polemap");
}

namespace {

constexpr double kSameTime = 1e-3;  ///< s: rawlogs and tables round times

/// `run_NN_cov.csv` of `run_NN.tum`.
std::filesystem::path besides(const std::filesystem::path& run, const std::string& ending) {
  return run.parent_path() / (run.stem().string() + ending);
}

void requireCovered(const MappingSession& session, const SessionFiles& files,
                    const PoleSequence& sequence) {
  const std::size_t known = session.scans.size() + session.skipped.notOk;
  if (session.skipped.unmatched <= known) return;
  throw Error(files.poses.string() + ": has a pose at the time of only " + std::to_string(known) +
              " of the " + std::to_string(known + session.skipped.unmatched) + " scans of " +
              files.input.string() + " (" + io::fixed(sequence.frames.front().time, 3) + " to " +
              io::fixed(sequence.frames.back().time, 3) +
              " s), at least half are needed; is it of this rawlog?");
}

void requireScans(const MappingSession& session, const std::filesystem::path& input) {
  if (!session.scans.empty()) return;
  std::ostringstream message;
  message << input.string() << ": no usable scan, " << session.skipped.emptyScans
          << " without a valid point";
  if (session.skipped.notOk > 0)
    message << ", " << session.skipped.notOk << " at which the localizer was not ok";
  throw Error(message.str());
}

/// A doubtful detection is worth keeping where others can confirm it.
SequenceOptions readingOf(const AllSettings& settings) {
  SequenceOptions options = settings.reading();
  if (settings.map.minConfidence <= 0) return options;
  options.extraction.extraction.scanLine.minConfidence = settings.map.minConfidence;
  for (LidarOptions& lidar : options.vehicle.lidars)
    lidar.extraction.scanLine.minConfidence = settings.map.minConfidence;
  return options;
}

void requireTimeGoesOn(const SessionFiles& files, const PoleSequence& sequence) {
  const auto& frames = sequence.frames;
  for (std::size_t i = 1; i < frames.size(); ++i)
    if (!(frames[i].time > frames[i - 1].time))
      throw Error(files.input.string() + ": time does not increase: scan " + std::to_string(i) +
                  " at " + io::fixed(frames[i].time, 6) + " s comes after one at " +
                  io::fixed(frames[i - 1].time, 6) +
                  " s; poses are found by time, so each scan needs its own, later than the last");
}

/// Motions one behind the other.
std::vector<StampedPose2D> deadReckoning(const PoleSequence& sequence) {
  std::vector<StampedPose2D> path;
  for (const PoleScan& frame : sequence.frames)
    path.push_back(
        {frame.time, path.empty() ? Pose2D() : compose(path.back().pose, frame.motion->mean)});
  return path;
}

}  // namespace

SessionPoses::SessionPoses(PoseKind kind, const std::filesystem::path& file)
    : m_kind(kind), m_file(file) {
  if (kind == PoseKind::truth) {
    m_trajectory = io::readPlanarTum(file);
    return;
  }
  const HealthRecords health(besides(file, "_health.csv"));
  const std::filesystem::path covariances = besides(file, "_cov.csv");
  for (const EstimateRecord& row : readEstimates(covariances)) {
    const bool ok = health.isOk(row.scan);
    if (!m_trajectory.empty() && !(row.time > m_trajectory.back().time))
      throw Error(covariances.string() + ": the times do not increase");
    m_trajectory.push_back({row.time, row.estimate.mean});
    m_estimates[static_cast<std::size_t>(row.scan)] = {
        row.time, {row.estimate.mean, row.estimate.covariance, ok}};
  }
}

SessionPoses::SessionPoses(std::vector<StampedPose2D> odometry)
    : m_kind(PoseKind::odometry), m_trajectory(std::move(odometry)) {}

std::optional<ScanPose> SessionPoses::at(std::size_t scan, double time) const {
  if (m_kind == PoseKind::estimate) return estimateOf(scan, time);
  const auto pose = poseAt(m_trajectory, time, longestTruthGap);
  return pose ? std::optional(ScanPose{*pose}) : std::nullopt;
}

std::optional<ScanPose> SessionPoses::estimateOf(std::size_t scan, double time) const {
  const auto found = m_estimates.find(scan);
  if (found == m_estimates.end()) return std::nullopt;
  const auto& [ownTime, pose] = found->second;
  if (std::abs(ownTime - time) <= kSameTime) return pose;
  throw Error(m_file.string() + ": scan " + std::to_string(scan) + " is of " +
              io::fixed(ownTime, 6) + " s, but that of the rawlog of " + io::fixed(time, 6) +
              " s; is it a run over this rawlog?");
}

Velocity SessionPoses::velocityAt(double time) const {
  // Half a turn of most LiDARs. Estimates vary from scan to scan: over a longer time, that matters
  // less.
  const double half = m_kind == PoseKind::estimate ? 0.25 : 0.05;
  return polemcl::velocityAt(m_trajectory, time, half, longestTruthGap);
}

MappingSession loadMappingSession(const SessionFiles& files, const AllSettings& settings,
                                  bool allowTruncated, const ScanProgress& progress) {
  const bool odometry = files.kind == PoseKind::odometry;
  SessionPoses poses =
      odometry ? SessionPoses(std::vector<StampedPose2D>()) : SessionPoses(files.kind, files.poses);
  SequenceOptions options = readingOf(settings);
  options.allowTruncated = allowTruncated;
  if (!odometry) options.velocity = [&](double time) { return poses.velocityAt(time); };
  PoleSequence sequence = readPoleSequence(files.input.string(), options, progress);
  requireTimeGoesOn(files, sequence);
  MappingSession session;
  if (odometry) {
    session.filled =
        io::located(files.input.string() + ": ", [&] { return fillMotions(sequence.frames); });
    poses = SessionPoses(deadReckoning(sequence));
  }
  const SequenceCounts& counts = sequence.counts;
  std::ostringstream sensors;
  printSensors(sensors, counts);
  session.skipped = {counts.emptyScans, 0, 0, counts.invalidPoints, counts.truncated,
                     sensors.str()};
  session.turnDoubts = turnDoubts(counts, settings.sensor.timing);
  session.looksRaw = !counts.untoldTurns.empty();
  std::optional<PoseWithCovariance> way;
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    const PoleScan& frame = sequence.frames[i];
    way =
        way && frame.motion ? std::optional(io::composeMotions(*way, *frame.motion)) : std::nullopt;
    if (frame.poles_robot.empty() && frame.points == 0) continue;  // blind: neither seen nor missed
    const auto scan = poses.at(i, frame.time);
    session.skipped.unmatched += !scan;
    session.skipped.notOk += scan && !scan->isOk;
    if (!scan || !scan->isOk) continue;
    auto poles_robot = frame.poles_robot;
    deskew(poles_robot, poses.velocityAt(frame.time));
    session.scans.push_back({frame.time, scan->pose, poles_robot, frame.visibilityRange,
                             frame.pose_robot_sensor, scan->covariance});
    session.path.push_back({frame.time, scan->pose});
    session.numbers.push_back(i);
    session.motions.push_back(way);
    way = PoseWithCovariance();
  }
  requireCovered(session, files, sequence);
  requireScans(session, files.input);
  return session;
}

void SkippedScans::operator+=(const SkippedScans& other) {
  emptyScans += other.emptyScans;
  unmatched += other.unmatched;
  notOk += other.notOk;
  invalidPoints += other.invalidPoints;
  truncated += other.truncated;
  sensors += other.sensors;
}

std::ostream& operator<<(std::ostream& out, const SkippedScans& skipped) {
  if (skipped.emptyScans > 0)
    out << "scans without a valid point, not used: " << skipped.emptyScans << '\n';
  if (skipped.unmatched > 0) out << "scans without a pose, not used: " << skipped.unmatched << '\n';
  if (skipped.notOk > 0)
    out << "scans at which the localizer was not ok, not used: " << skipped.notOk << '\n';
  if (skipped.invalidPoints > 0) out << "invalid points dropped: " << skipped.invalidPoints << '\n';
  out << skipped.sensors;
  if (skipped.truncated > 0)
    out << "inputs that ended too early: " << skipped.truncated
        << "; what could be read was used\n";
  return out;
}

void writeViews(const MappingJob& job, const io::PoleMapData& map, const report::MapView& view) {
  if (job.csv) io::writePoleCsv(*job.csv, map.poles, map.histories);
  if (job.scene) scene::save(*report::makeMapScene(view), *job.scene);
}

void keepWarnings(const std::vector<std::string>& warnings,
                  std::map<std::string, std::string>& info) {
  for (const std::string& warning : warnings)
    if (info["warnings"].find(warning) == std::string::npos)
      info["warnings"] += (info["warnings"].empty() ? "" : "; ") + warning;
}

SessionFiles MappingJob::session(std::size_t i) const {
  return {inputs[i], poses.empty() ? std::filesystem::path() : poses[i], kind};
}

void setDate(std::vector<SessionScan>& scans, const std::string& date) {
  const double day = io::secondsOfDate(date);
  if (scans.empty()) return;
  const double shift = day - scans.front().time;
  for (SessionScan& scan : scans) scan.time += shift;
}

}  // namespace polemcl::apps
