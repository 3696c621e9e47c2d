#include "eval/TrialDrive.h"

#include <cmath>

#include "core/common/Angles.h"
#include "eval/DriveTruth.h"
#include "localize/LocalizeApp.h"

namespace polemcl::apps {

TrialDrive loadTrialDrive(const TrialDriveFiles& files) {
  const AllSettings settings = loadSettings(files.config.string(), files.set);
  TrialDrive drive{settings,
                   LocalizationMap(loadPoleMap(files.map, settings.likelihood)),
                   readPoleSequence(files.input.string(), settings.reading()).frames,
                   {},
                   {}};
  const DriveTruth truth(files.truth, files.input);
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    const PoleScan& frame = drive.frames[i];
    if (i > 0 && !frame.motion)
      throw Error(files.input.string() + ": no odometry before scan " + std::to_string(i) +
                  ": the filter needs it");
    drive.truth.push_back(truth.at(frame.time, i));
    drive.driven.push_back(
        i > 0 ? drive.driven[i - 1] + errorOf(drive.truth[i], drive.truth[i - 1]).metres : 0);
  }
  return drive;
}

bool PlanarError::isRight() const {
  return metres <= 0.5 && radians <= 2 * degree;
}

PlanarError errorOf(const Pose2D& estimate, const Pose2D& truth) {
  return {std::hypot(estimate.x - truth.x, estimate.y - truth.y),
          std::abs(wrapAngle(estimate.yaw - truth.yaw))};
}

}  // namespace polemcl::apps
