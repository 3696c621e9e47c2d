#pragma once
/// \file TrialDrive.h
/// \brief A drive of stored poles with its truth and a map: what trials of the localization are
/// taken from.

#include <filesystem>
#include <string>
#include <vector>

#include <polemcl/localizer/Localizer.h>
#include "cli/Settings.h"
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
  std::vector<Pose2D> truth;   ///< of each frame
  std::vector<double> driven;  ///< along the true path from the first frame to each, m
};

/// \brief Reads everything. \throws Error naming the file: a scan without motion (but the first) or
/// without a true pose at its time, and as the readers do.
TrialDrive loadTrialDrive(const TrialDriveFiles& files);

/// \brief Position and heading error, m and rad, both 0 or more.
struct PlanarError {
  double metres, radians;
  /// \brief Within 0.5 m and 2 degrees of the true pose.
  bool isRight() const;
};
PlanarError errorOf(const Pose2D& estimate, const Pose2D& truth);

}  // namespace polemcl::apps
