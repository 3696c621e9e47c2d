#pragma once
/// \file MappingSession.h
/// \brief One rawlog at known poses, ready for mapping; what building and updating share.

#include <Eigen/Core>
#include <filesystem>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "cli/Settings.h"
#include "core/common/Deskew.h"
#include "core/evaluation/TrajectoryEvaluation.h"
#include "core/mapping/MapUpdater.h"
#include "core/slam/PoleMotions.h"
#include "io/map/Datum.h"
#include "io/map/PoleMapFile.h"
#include "mrpt/rawlog/PoleSequence.h"
#include "report/picture/MapView.h"

namespace polemcl::apps {

/// \brief Where poses of sessions come from.
enum class PoseKind {
  truth,     ///< a TUM file
  estimate,  ///< a run of `pole-localize`
  odometry   ///< no file: motions one behind the other, for mapDrives() to make better
};

/// \brief The pose of one scan.
struct ScanPose {
  Pose2D pose;                                           ///< of the robot in the map, m and rad
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< x, y, yaw, m and rad; zero for truth
  bool isOk = true;  ///< false: the localizer was `degraded` or `lost` there
};

/// \brief The poses of one session, from one file.
class SessionPoses {
 public:
  /// \param file For truth: TUM, robot poses. For an estimate: `run_NN.tum` of `pole-localize`;
  /// poses and covariances are read from the `run_NN_cov.csv` beside it, its health from
  /// `run_NN_health.csv`.
  /// \throws Error when a file cannot be read.
  SessionPoses(PoseKind kind, const std::filesystem::path& file);
  /// \brief Poses by the odometry, from the first scan on.
  explicit SessionPoses(std::vector<StampedPose2D> odometry);

  /// \brief None where the file says nothing.
  /// \param scan Number of the scan in its rawlog. \param time Time of the scan, s.
  /// \throws Error when an estimate for this scan has another time: it is of another rawlog.
  std::optional<ScanPose> at(std::size_t scan, double time) const;
  /// \brief Velocity in the frame of the robot, from the poses before and after; zero where there
  /// is a gap.
  Velocity velocityAt(double time) const;

 private:
  std::optional<ScanPose> estimateOf(std::size_t scan, double time) const;

  PoseKind m_kind;
  std::filesystem::path m_file;
  std::vector<StampedPose2D> m_trajectory;
  struct Estimate {
    double time = 0;
    ScanPose pose;
  };
  std::map<std::size_t, Estimate> m_estimates;  ///< by the number of the scan
};

/// \brief Files of one session.
struct SessionFiles {
  std::filesystem::path input;  ///< rawlog of scans or poles
  std::filesystem::path poses;  ///< see SessionPoses
  PoseKind kind = PoseKind::truth;
};

/// \brief Files of a job that maps sessions, as the command line names them.
struct MappingJob {
  std::vector<std::filesystem::path> inputs;       ///< rawlogs of scans or poles, one per session
  std::vector<std::filesystem::path> poses;        ///< robot poses, one file per input, or none
  std::filesystem::path output;                    ///< `.polemap`
  std::optional<std::filesystem::path> scene;      ///< `.3Dscene` of map and paths, when given
  std::optional<std::filesystem::path> csv;        ///< poles as a table, when given
  bool allowTruncated = false;                     ///< use the readable part of damaged rawlogs
  std::vector<std::string> dates = {};             ///< YYYY-MM-DD, one per input, or empty
  std::optional<io::Datum> datum = {};             ///< of the truths: goes into the map's info
  PoseKind kind = PoseKind::truth;                 ///< of `poses`; odometry: there are none
  std::optional<std::filesystem::path> json = {};  ///< summary for scripts, when given

  /// \brief What is wrong with the numbers of files and dates; empty when nothing is.
  std::string wrongCounts() const;
  /// \throws Error naming the option.
  void validate() const;
  /// \brief The files of one of the inputs.
  SessionFiles session(std::size_t i) const;
};

/// \brief Scans that were not used, of one session or of several.
struct SkippedScans {
  std::size_t emptyScans = 0;     ///< without a valid point
  std::size_t unmatched = 0;      ///< scans of whose pose nothing is known
  std::size_t notOk = 0;          ///< scans at which the localizer was `degraded` or `lost`
  std::size_t invalidPoints = 0;  ///< dropped
  std::size_t truncated = 0;      ///< inputs that ended too early, and that was allowed
  std::string sensors = {};       ///< lines of printSensors()
  void operator+=(const SkippedScans& other);
};

/// \brief The scans of one drive that have a pose and a point.
struct MappingSession {
  std::vector<SessionScan> scans;
  std::vector<StampedPose2D> path;   ///< of the scans
  std::vector<std::size_t> numbers;  ///< of the scans, in the rawlog
  /// Odometry to each scan from the one before that is here; none of the first, and where a motion
  /// on the way is not known.
  std::vector<std::optional<PoseWithCovariance>> motions;
  FilledMotions filled;  ///< motions that the odometry did not tell
  SkippedScans skipped;
  std::vector<std::string> turnDoubts;  ///< turnDoubts() of its LiDARs
  bool looksRaw = false;                ///< its scans, though nothing says so
};

/// \brief Reads a rawlog of scans or poles; doubtful detections down to `[map] min_confidence`.
/// \param progress May be empty.
/// \throws Error as readPoleSequence() and SessionPoses; when a motion is missing that stands for
///         poses; when less than half of the scans have a pose; when no scan is left; when the time
///         of a scan is not later than that of the one before.
MappingSession loadMappingSession(const SessionFiles& files, const AllSettings& settings,
                                  bool allowTruncated, const ScanProgress& progress);

/// \brief A line for each count above 0.
std::ostream& operator<<(std::ostream& out, const SkippedScans& skipped);

/// \brief Writes table and scene of a new map, when the job names them.
void writeViews(const MappingJob& job, const io::PoleMapData& map, const report::MapView& view);

/// \brief Adds warnings to those in a map's info, key `warnings`, unless they are there.
void keepWarnings(const std::vector<std::string>& warnings,
                  std::map<std::string, std::string>& info);

/// \brief The scans on another day: their times count from the first one.
/// \param date YYYY-MM-DD. \throws Error when it is not a date.
void setDate(std::vector<SessionScan>& scans, const std::string& date);

}  // namespace polemcl::apps
