#pragma once
/// \file DriveTruth.h
/// \brief A rawlog of poles with its true poses, as the commands of `pole-eval` read them.

#include <filesystem>
#include <functional>
#include <vector>

#include "core/evaluation/TrajectoryEvaluation.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl::apps {

/// \brief The true poses of the scans of a rawlog.
class DriveTruth {
 public:
  /// \param rawlog Holds the scans; only for messages. \throws Error as readTum().
  DriveTruth(const std::filesystem::path& tum, const std::filesystem::path& rawlog);
  /// \brief The pose at the time of a scan. \throws Error naming the files when the truth has no
  /// pose then.
  Pose2D at(double time, std::size_t scan) const;
  /// \brief The poles of a scan in the robot frame, where they are seen from at its time: corrected
  /// for the true motion during the scan.
  std::vector<PoleDetection> deskewed(const ReadScan& scan) const;

 private:
  std::filesystem::path m_tum, m_rawlog;
  std::vector<StampedPose2D> m_poses;
};

/// \brief Streams a rawlog of poles. \throws Error as streamPoles(), and when it holds scans.
void streamStoredPoles(const std::filesystem::path& rawlog,
                       const std::function<void(const ReadScan&)>& consume);

}  // namespace polemcl::apps
