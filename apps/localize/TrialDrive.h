#pragma once
/// \file TrialDrive.h
/// \brief A drive of stored poles with its truth and a map: what experiments on the localization
/// take their trials from.

#include <filesystem>
#include <functional>
#include <vector>

#include "cli/Settings.h"
#include "core/evaluation/TrajectoryEvaluation.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl::apps {

struct TrialDriveFiles {
  std::filesystem::path config, map, input, truth;  ///< INI, .polemap, rawlog of poles, TUM
  std::vector<std::string> set = {};                ///< `section.key=value`, see loadSettings()
};

struct TrialDrive {
  AllSettings settings;
  LocalizationMap map;
  std::vector<PoleScan> frames;
  std::vector<Pose2D> truth;  ///< of each frame
};

/// \brief Reads everything. \throws Error naming the file: a scan without motion (but the first) or
/// without a true pose at its time, and as the readers do.
TrialDrive loadTrialDrive(const TrialDriveFiles& files);

/// \brief Position and heading error, m and rad, both 0 or more.
struct PlanarError {
  double metres, radians;
};
PlanarError errorOf(const Pose2D& estimate, const Pose2D& truth);
/// \brief Within 0.5 m and 2 degrees of the true pose.
bool isRight(const PlanarError& error);

/// \brief Distance driven from the first pose to each, m.
std::vector<double> distancesDriven(const std::vector<Pose2D>& truth);
/// \brief The value below which this share of them lies, at the nearest rank; 0 without values.
double rankedValue(const std::vector<double>& values, double share);

/// \brief The true pose at the time of a scan. \param rawlog That holds the scan, for messages.
/// \throws Error naming the files when the truth has none.
Pose2D truePose(const std::vector<StampedPose2D>& truth, const std::filesystem::path& truthFile,
                double time, std::size_t scan, const std::filesystem::path& rawlog);

/// \brief The poles of a scan in the robot frame, where they are seen from at its time: corrected
/// for the true motion during the scan.
std::vector<PoleDetection> trulyDeskewed(const ReadScan& scan,
                                         const std::vector<StampedPose2D>& truth);

/// \brief Streams a rawlog of poles. \throws Error as streamPoles(), and when it holds scans.
void streamStoredPoles(const std::filesystem::path& rawlog,
                       const std::function<void(const ReadScan&)>& consume);

/// \brief A map for `settings` from a file. \throws Error when it cannot be read or has no poles.
std::shared_ptr<const CPoleMap> loadPoleMap(const std::filesystem::path& file,
                                            const LikelihoodOptions& likelihood);

}  // namespace polemcl::apps
