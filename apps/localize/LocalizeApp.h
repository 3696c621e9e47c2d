#pragma once
/// \file LocalizeApp.h
/// \brief `pole-localize`: plays a rawlog, or sensors, against a pole map, and says how well it
/// went.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/evaluation/TrajectoryEvaluation.h"
#include "localize/FilterRuns.h"
#include "localize/LocalizeTimings.h"
#include "localize/RunFiles.h"

namespace polemcl::apps {

/// \brief What the command line says. Values given here take the place of the configuration's.
struct LocalizeJob {
  std::filesystem::path config, input, map, output;
  std::filesystem::path sensors;  ///< in place of `input`: INI file of sensors; or empty
  double seconds = 0;             ///< length of a drive with sensors, s; 0: no end
  std::optional<std::filesystem::path> record = {};  ///< rawlog of a drive with sensors
  std::vector<std::string> set;                      ///< `section.key=value`, see loadSettings()
  std::optional<std::filesystem::path> truth;        ///< TUM
  std::optional<int> runs, particles;
  std::optional<std::uint32_t> seed;
  std::vector<double> start;  ///< x, y (m), yaw (deg), radius (m), heading (deg); or empty
  bool anywhere = false;      ///< no start pose: global search
  bool startByGnss = false;   ///< global search near the first fix of `input`
  /// \name How the drive is played and its first run watched, as in `[view]`
  /// @{
  bool live = false, hold = false;
  std::optional<std::string> rate;  ///< of the input, with a window or without
  std::optional<std::string> frames;
  std::optional<int> scenes, frameEvery;
  /// @}
  bool allowTruncated = false;
  double follow = 0;                            ///< wait at the end of the rawlog for more, s
  std::optional<std::filesystem::path> stream;  ///< see PoseStream; "-": standard output
  std::optional<std::filesystem::path> bag;     ///< MCAP of the first run, see RunBag
  bool quiet = false;

  bool isLive() const { return !sensors.empty(); }
  /// \brief Where the scans come from: `input` or `sensors`.
  const std::filesystem::path& source() const { return isLive() ? sensors : input; }
};

struct LocalizeResult {
  std::vector<FilterRun> runs;
  /// Errors of each run, without those of single poses; empty without truth; none for a run that
  /// never found its pose.
  std::vector<std::optional<TrajectoryErrors>> errors;
  SpreadCheck spreadCheck;  ///< of all runs
  LocalizeTimings timings;
};

/// \brief Plays the rawlog: reads, extracts, filters, shows and writes scan by scan. All runs take
/// each scan side by side, with the same bytes as one by one.
///
/// Memory does not grow with the length of the drive, but for the truth (32 bytes a pose) and,
/// while the run is watched, the paths (32 bytes a metre each) and, with a window, what KeptMoments
/// keeps of each scan (2 kB). By default a scan follows
/// the one before as fast as it goes. `--rate` sets a pace (see Pace.h); with a window `[view]
/// rate` does (1x by default), until the user closes it. A user who pauses or goes back in the
/// window makes a rawlog wait; the results stay the same.
///
/// With sensors, scans that come faster than they can be handled are dropped (see LiveQueue), and
/// the drive ends with a signal (see LiveDrive.h). A sensor that fails ends it as well, and so
/// does a stream that cannot be written; the error comes after the results are complete.
///
/// The folder `output` gets:
/// - `run_NN.tum`: the estimated robot poses, a row per scan, the first included, at its time;
///   started anywhere, from the scan on by which the pose is known;
/// - `run_NN_cov.csv`: `scan,timestamp,x_m,y_m,yaw_rad,xx,xy,xyaw,yy,yyaw,yawyaw`: the same poses
///   and their covariances, map frame, m², m·rad, rad²;
/// - `run_NN_health.csv`: `scan,timestamp,state,reason,matched_share,seen_share,innovation,
///   effective_particles,particles,mode_share,spread_m,spread_deg,poles,relocalized` of every scan
///   (see LocalizationHealth.h; `relocalized` is 1 where the global search set the pose);
/// - `run_NN_errors.csv`, with truth: `scan,timestamp,position_m,lateral_m,longitudinal_m,
///   heading_deg,poles,effective_share` of each scan that the truth covers; scan is the 0-based
///   index in the input, lateral + to the left and longitudinal + ahead of the true pose, heading +
///   counter-clockwise, poles the number observed, effective_share that of the particles;
/// - `run_00_scenes/NNNNNN.3Dscene`, if asked for: the first run after scan NNNNNN (see
///   report/scene/LiveScene.h; stock objects);
/// - `summary.json`: what went in; with truth the figures of `pole-eval trajectory` as means over
///   the runs (`pos_max`: the largest), their standard deviations in `spread`, each run in `runs`,
///   and in `ok_beyond_spread` the scans of all runs that were `ok` though the error was above 0.5
///   m and 5 times the spread; `start_source` says who gave the start pose: the `truth` (at the
///   first scan), the `configuration`, the `command line`, or nobody: the start is `anywhere`, or
///   near the first fix of the rawlog (`gnss`); with sensors also `dropped_scans`,
///   `lost_packets`, `ignored_packets` and `scans_without_odometry`, which are left out;
/// - `config.ini`: the effective configuration;
/// - `timings.json`: the only file that differs from repetition to repetition. `wall_s`, `rate`
///   (times the pace of the recording, 1 with sensors, or `max`), `filter_s` of each run, and in
///   `latency_ms` for each stage `median p99 p99.9 worst count` (see LocalizeTimings.h; to 0.5 %,
///   `worst` exactly): `read` (with sensors the wait until the scan is taken), `extract` (not for
///   stored poles), `step` of each run, `write` with the view, and `total`, from the moment a scan
///   is there until all runs have its pose and it is streamed. With sensors that is the moment at
///   which the driver gives the scan, at a rate the one at which the scan is due. At full speed it
///   is the one at which it has been read, so that `total` contains the wait for the scans before
///   it.
///
/// The bag of the first run, if asked for, appears under its name when it is complete (RunBag.h).
///
/// Results grow in a hidden folder beside files of an earlier call, which they replace once
/// everything is complete. Prints a table on stdout unless quiet; on stderr when poses are streamed
/// to stdout.
/// \throws Error as the readers do, and when the map has no poles, scans lack odometry, no pole is
///         ever seen, there is no start pose or it is more than 1 km from all poles of the map, or
///         the truth covers less than half of the scans. The folder is as it was before then, but
///         with scans of sensors, and where only `bag` or `stream` cannot be written: it then has
///         the results.
LocalizeResult localize(const LocalizeJob& job);

/// \brief A map for `settings` from a file. \throws Error when it cannot be read or has no poles.
std::shared_ptr<const CPoleMap> loadPoleMap(const std::filesystem::path& file,
                                            const LikelihoodOptions& likelihood);

/// \brief The program. \return Its exit code.
int localizeMain(int argc, const char* const* argv);

}  // namespace polemcl::apps
