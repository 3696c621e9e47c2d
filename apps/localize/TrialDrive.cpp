#include "localize/TrialDrive.h"

#include <algorithm>
#include <cmath>

#include <polemcl/core/evaluation/TrajectoryEvaluation.h>
#include "core/common/Angles.h"
#include "core/common/PoseInterpolation.h"
#include "io/data/Trajectory.h"

namespace polemcl::apps {

std::shared_ptr<const CPoleMap> loadPoleMap(const std::filesystem::path& file,
                                            const LikelihoodOptions& likelihood) {
  auto map = std::make_shared<CPoleMap>();
  map->likelihoodOptions = likelihood;  // first: loading prepares the index for its gate
  map->loadFromPoleMapFile(file.string());
  if (map->poles().empty())
    throw Error(file.string() + ": the map has no poles: nothing can be localized in it");
  return map;
}

TrialDrive loadTrialDrive(const TrialDriveFiles& files) {
  const Settings settings = loadSettings(files.config.string(), files.set);
  SequenceOptions reading;
  reading.extraction = settings.poleExtraction();
  reading.motion = settings.motion;
  TrialDrive drive{settings,
                   LocalizationMap(loadPoleMap(files.map, settings.likelihood), settings.global),
                   readPoleSequence(files.input.string(), reading).frames,
                   {}};
  const auto truth = io::planar(io::readTum(files.truth));
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    const PoleFrame& frame = drive.frames[i];
    const auto pose = poseAt(truth, frame.time, longestTruthGap);
    if (!pose)
      throw Error(files.truth.string() + ": no true pose at " + std::to_string(frame.time) +
                  " s, the time of scan " + std::to_string(i) + " of " + files.input.string());
    if (i > 0 && !frame.motion)
      throw Error(files.input.string() + ": no odometry before scan " + std::to_string(i) +
                  ": the filter needs it");
    drive.truth.push_back(*pose);
  }
  return drive;
}

PlanarError errorOf(const Pose2D& estimate, const Pose2D& truth) {
  return {std::hypot(estimate.x - truth.x, estimate.y - truth.y),
          std::abs(wrapAngle(estimate.yaw - truth.yaw))};
}

bool isRight(const PlanarError& error) {
  return error.metres <= 0.5 && error.radians <= 2 * degree;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

}  // namespace polemcl::apps
