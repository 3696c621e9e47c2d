#pragma once
/// \file Trial.h
/// \brief One trial of the localization: a stretch of a drive, what is changed in it, and what
/// comes of it.

#include <filesystem>
#include <map>
#include <optional>
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

/// \brief A drive of stored poles with its truth and a map, from which trials are taken.
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

/// \brief What the localization is shown. Element i of the lists is scan i.
struct Trial {
  std::optional<Pose2D> start;  ///< pose given to the filter; none: it starts anywhere
  std::vector<PoleScan> frames;
  std::vector<Pose2D> truth;
  std::vector<double> driven;  ///< along the true path since the first scan, jumps left out, m
  std::size_t begin = 0;       ///< first scan with the fault; without one, the first scan
  std::size_t end = 0;         ///< first scan after it; `begin` for what lasts no time
  std::size_t origin = 0;      ///< scan of the whole drive that is the first here
  double jump = 0;             ///< distance of a kidnapping, or of a jump of the odometry, m
};

/// \brief Scans of the drive as they are, without a start. \param end First scan left out.
Trial stretchOf(const TrialDrive& drive, std::size_t first, std::size_t end);

/// \brief What is recorded of a scan.
struct TrialScan {
  double time, driven;  ///< s; as in Trial, m
  PlanarError error;    ///< infinite while the pose is unknown
  double sigmas;        ///< position error in its own standard deviations; infinite as well
  HealthState state;
  HealthReason reason;
  bool relocalized;
  std::optional<double> searchSeconds;  ///< time of the step, if the map was searched in it
};

/// \brief Drives a trial with a localization of its own.
std::vector<TrialScan> record(const Trial& trial, const Settings& settings,
                              const LocalizationMap& map, std::uint32_t seed);

/// \brief When something came to be, since another moment.
struct Delay {
  double seconds = 0;
  double metres = 0;  ///< along the true path
};

/// \brief The scans from the first `ok` on.
struct HealthCounts {
  double seconds = 0, metres = 0;
  std::size_t scans = 0, ok = 0, degraded = 0, lost = 0;
  std::size_t lostTimes = 0, degradedTimes = 0;  ///< a run of scans counts once
  double longestSeconds = 0;                     ///< longest run of scans that are not `ok`
  std::map<std::string, std::size_t> reasons;    ///< scans by reason, those not `ok`
  double errorSum = 0, errorMax = 0;             ///< m, over all scans
  std::size_t wrongOk = 0;                       ///< `ok` with a wrong pose
  std::size_t relocalized = 0;
  double okBeyondSeconds = 0;  ///< as in TrialOutcome
  std::size_t lostBefore = 0;  ///< scans called lost before the first `ok`

  void add(const HealthCounts& run);
};

/// \brief What came of a trial. Delays count from `begin` or `end` of the trial; none: it never was
/// so. A pose is right within 0.5 m and 2 degrees.
struct TrialOutcome {
  std::size_t scan = 0;   ///< Trial::origin
  double jump = 0;        ///< Trial::jump, m
  bool okBefore = false;  ///< in the scan before `begin`
  /// \name Since `begin`
  /// @{
  std::optional<Delay> degraded, lost;  ///< first `degraded` or `lost`; first `lost`
  std::string lostReason;               ///< then; empty if never
  std::optional<Delay> said;            ///< first pose that is neither `lost` nor ambiguous
  PlanarError saidError{};              ///< of that pose
  std::optional<Delay> saidOk;          ///< first `ok`
  double okWrongMetres = 0;             ///< driven while `ok` is said of a wrong pose
  bool okWrong = false;                 ///< that happened in at least one scan
  double okBeyondSeconds = 0;           ///< longest in a row: `ok`, beyond 5 standard deviations
  double errorMax = 0;                  ///< greatest of the position, m
  /// @}
  /// \name Since `end`
  /// @{
  std::optional<Delay> right;         ///< the pose is right, and stays so over the next 5 m
  std::optional<Delay> rightForGood;  ///< and stays so for the rest of the trial
  std::optional<Delay> ok;            ///< `ok`, with the right pose
  std::optional<double> errorAfter;   ///< of the position, mean over the 20 m after `ok`, m
  /// @}
  double meanError = 0, endError = 0;  ///< of the position: over all scans; in the last, m
  std::vector<double> searchSeconds;   ///< of each step in which the map was searched
  HealthCounts health;
};

TrialOutcome outcomeOf(const Trial& trial, const std::vector<TrialScan>& scans);

}  // namespace polemcl::apps
