#include "map/MappingSession.h"

#include <ostream>

#include <polemcl/core/common/Deskew.h>
#include "core/common/PoseInterpolation.h"
#include "io/data/Trajectory.h"
#include "io/file/Date.h"
#include "io/file/TextFile.h"
#include "io/map/PolePositions.h"
#include "report/scene/MapScene.h"

namespace polemcl::apps {

std::string MappingJob::wrongCounts() const {
  const std::string files = std::to_string(inputs.size());
  if (inputs.empty()) return "--input: at least one rawlog is needed";
  if (inputs.size() != truths.size())
    return "--truth: one file per --input is needed, " + files + ", not " +
           std::to_string(truths.size());
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

/// Velocity at a time, from the poses 0.05 s before and after, half a turn of most LiDARs. Zero
/// where the trajectory has a gap.
Velocity velocityAt(const std::vector<StampedPose2D>& trajectory, double time) {
  constexpr double half = 0.05;
  const auto here = poseAt(trajectory, time, longestTruthGap);
  const auto before = poseAt(trajectory, time - half, longestTruthGap);
  const auto after = poseAt(trajectory, time + half, longestTruthGap);
  if (before && after) return velocityOf(relative(*before, *after), 2 * half);
  if (after && here) return velocityOf(relative(*here, *after), half);
  if (before && here) return velocityOf(relative(*before, *here), half);
  return {};
}

}  // namespace

MappingSession loadMappingSession(const std::filesystem::path& input,
                                  const std::filesystem::path& truthFile, const Settings& settings,
                                  bool allowTruncated, const ScanProgress& progress) {
  SequenceOptions options{settings.poleExtraction(), settings.motion, allowTruncated};
  // A doubtful detection is worth keeping where others can confirm it.
  if (settings.map.minConfidence > 0)
    options.extraction.extraction.scanLine.minConfidence = settings.map.minConfidence;
  const PoleSequence sequence = readPoleSequence(input.string(), options, progress);
  const auto truth = io::readPlanarTum(truthFile);
  MappingSession session;
  const SequenceCounts& counts = sequence.counts;
  session.skipped = {counts.emptyScans, 0, counts.invalidPoints, counts.truncated};
  for (const auto& frame : sequence.frames) {
    if (frame.poles_robot.empty() && frame.points == 0) continue;  // blind: neither seen nor missed
    const auto pose = poseAt(truth, frame.time, longestTruthGap);
    if (!pose) {
      ++session.skipped.unmatched;
      continue;
    }
    auto poles_robot = frame.poles_robot;
    deskew(poles_robot, velocityAt(truth, frame.time));
    session.scans.push_back(
        {frame.time, *pose, poles_robot, frame.visibilityRange, frame.pose_robot_sensor});
    session.path.push_back({frame.time, *pose});
  }
  if (session.skipped.unmatched > session.scans.size())
    throw Error(truthFile.string() + ": has a pose at the time of only " +
                std::to_string(session.scans.size()) + " of the " +
                std::to_string(session.scans.size() + session.skipped.unmatched) + " scans of " +
                input.string() + " (" + io::fixed(sequence.frames.front().time, 3) + " to " +
                io::fixed(sequence.frames.back().time, 3) +
                " s), at least half are needed; is it "
                "the truth of this rawlog?");
  return session;
}

void SkippedScans::operator+=(const SkippedScans& other) {
  emptyScans += other.emptyScans;
  unmatched += other.unmatched;
  invalidPoints += other.invalidPoints;
  truncated += other.truncated;
}

std::ostream& operator<<(std::ostream& out, const SkippedScans& skipped) {
  if (skipped.emptyScans > 0)
    out << "scans without a valid point, not used: " << skipped.emptyScans << '\n';
  if (skipped.unmatched > 0)
    out << "scans without a true pose, not used: " << skipped.unmatched << '\n';
  if (skipped.invalidPoints > 0) out << "invalid points dropped: " << skipped.invalidPoints << '\n';
  if (skipped.truncated > 0)
    out << "inputs that ended too early: " << skipped.truncated
        << "; what could be read was used\n";
  return out;
}

void writeViews(const MappingJob& job, const io::PoleMapData& map,
                const std::vector<StampedPose2D>& path) {
  if (job.csv) io::writePoleCsv(*job.csv, map.poles, map.histories);
  if (!job.scene) return;
  report::MapView view;
  view.title = job.output.filename().string();
  view.poles = map.poles;
  view.truth = path;
  scene::save(*report::makeMapScene(view), *job.scene);
}

void setDate(std::vector<SessionScan>& scans, const std::string& date) {
  const double day = io::secondsOfDate(date);
  if (scans.empty()) return;
  const double shift = day - scans.front().time;
  for (SessionScan& scan : scans) scan.time += shift;
}

}  // namespace polemcl::apps
