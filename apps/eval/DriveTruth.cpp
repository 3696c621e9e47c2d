#include "eval/DriveTruth.h"

#include "core/common/PoseInterpolation.h"
#include "io/data/Trajectory.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {

DriveTruth::DriveTruth(const std::filesystem::path& tum, const std::filesystem::path& rawlog)
    : m_tum(tum), m_rawlog(rawlog), m_poses(io::readPlanarTum(tum)) {}

Pose2D DriveTruth::at(double time, std::size_t scan) const {
  const auto pose = poseAt(m_poses, time, longestTruthGap);
  if (!pose)
    throw Error(m_tum.string() + ": no true pose at " + io::fixed(time, 6) +
                " s, the time of scan " + std::to_string(scan) + " of " + m_rawlog.string());
  return *pose;
}

std::vector<PoleDetection> DriveTruth::deskewed(const ReadScan& scan) const {
  constexpr double kHalf = 0.05;  // s: half a turn of most LiDARs
  auto poles_robot = scan.observation->polesInRobotFrame();
  deskew(poles_robot, velocityAt(m_poses, scan.time, kHalf, longestTruthGap));
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

}  // namespace polemcl::apps
