#include "map/MappingSession.h"

#include "core/common/PoseInterpolation.h"
#include "core/evaluation/TrajectoryEvaluation.h"
#include "io/data/Trajectory.h"
#include "io/file/Date.h"
#include "io/file/TextFile.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl::apps {
namespace {}  // namespace

MappingSession loadMappingSession(const std::filesystem::path& input,
                                  const std::filesystem::path& truthFile, const Settings& settings,
                                  bool allowTruncated, const ScanProgress& progress) {
  SequenceOptions options{settings.poleExtraction(), settings.motion, allowTruncated};
  // A doubtful detection is worth keeping where others can confirm it.
  if (settings.map.minConfidence > 0)
    options.extraction.extraction.scanLine.minConfidence = settings.map.minConfidence;
  const PoleSequence sequence = readPoleSequence(input.string(), options, progress);
  const auto truth = io::planar(io::readTum(truthFile));
  MappingSession survey;
  for (const auto& frame : sequence.frames) {
    if (frame.poles_robot.empty() && frame.points == 0) continue;  // blind: neither seen nor missed
    const auto pose = poseAt(truth, frame.time, longestTruthGap);
    if (!pose) {
      ++survey.unmatched;
      continue;
    }
    survey.scans.push_back(
        {frame.time, *pose, frame.poles_robot, frame.visibilityRange, frame.pose_robot_sensor});
    survey.path.push_back({frame.time, *pose});
  }
  if (survey.unmatched > survey.scans.size())
    throw Error(truthFile.string() + ": has a pose at the time of only " +
                std::to_string(survey.scans.size()) + " of the " +
                std::to_string(survey.scans.size() + survey.unmatched) + " scans of " +
                input.string() + " (" + io::fixed(sequence.frames.front().time, 3) + " to " +
                io::fixed(sequence.frames.back().time, 3) +
                " s), at least half are needed; is it "
                "the truth of this rawlog?");
  survey.emptyScans = sequence.counts.emptyScans;
  survey.invalidPoints = sequence.counts.invalidPoints;
  survey.truncated = sequence.counts.truncated;
  return survey;
}

void setDate(std::vector<SessionScan>& scans, const std::string& date) {
  const double day = io::secondsOfDate(date);
  if (scans.empty()) return;
  const double shift = day - scans.front().time;
  for (SessionScan& scan : scans) scan.time += shift;
}

}  // namespace polemcl::apps
