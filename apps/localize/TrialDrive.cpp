#include "localize/TrialDrive.h"

#include <cmath>

#include "core/common/Angles.h"
#include "core/common/PoseInterpolation.h"
#include "core/common/Statistics.h"
#include "io/data/Trajectory.h"
#include "io/file/TextFile.h"

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
  const AllSettings settings = loadSettings(files.config.string(), files.set);
  TrialDrive drive{settings,
                   LocalizationMap(loadPoleMap(files.map, settings.likelihood)),
                   readPoleSequence(files.input.string(), settings.reading()).frames,
                   {}};
  const auto truth = io::readPlanarTum(files.truth);
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    const PoleScan& frame = drive.frames[i];
    if (i > 0 && !frame.motion)
      throw Error(files.input.string() + ": no odometry before scan " + std::to_string(i) +
                  ": the filter needs it");
    drive.truth.push_back(truePose(truth, files.truth, frame.time, i, files.input));
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

std::vector<double> distancesDriven(const std::vector<Pose2D>& truth) {
  std::vector<double> driven(truth.size(), 0);
  for (std::size_t i = 1; i < truth.size(); ++i)
    driven[i] = driven[i - 1] + errorOf(truth[i], truth[i - 1]).metres;
  return driven;
}

Pose2D truePose(const std::vector<StampedPose2D>& truth, const std::filesystem::path& truthFile,
                double time, std::size_t scan, const std::filesystem::path& rawlog) {
  const auto pose = poseAt(truth, time, longestTruthGap);
  if (!pose)
    throw Error(truthFile.string() + ": no true pose at " + io::fixed(time, 6) +
                " s, the time of scan " + std::to_string(scan) + " of " + rawlog.string());
  return *pose;
}

std::vector<PoleDetection> trulyDeskewed(const ReadScan& scan,
                                         const std::vector<StampedPose2D>& truth) {
  constexpr double half = 0.05;  // s: half a turn of most LiDARs
  auto poles_robot = scan.observation->polesInRobotFrame();
  deskew(poles_robot, velocityAt(truth, scan.time, half, longestTruthGap));
  return poles_robot;
}

void streamStoredPoles(const std::filesystem::path& rawlog,
                       const std::function<void(const ReadScan&)>& consume) {
  streamPoles(rawlog.string(), {}, [&](const ReadScan& scan) {
    if (!scan.stored)
      throw Error(rawlog.string() +
                  ": holds scans, not poles; extract them with pole-extract first");
    consume(scan);
  });
}

double rankedValue(const std::vector<double>& values, double share) {
  return values.empty() ? 0 : nearestRank(values, share);
}

}  // namespace polemcl::apps
