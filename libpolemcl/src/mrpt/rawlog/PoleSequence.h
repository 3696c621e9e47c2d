#pragma once
/// \file PoleSequence.h
/// \brief Reads a rawlog of scans or poles as poles with the motions between them. Extraction runs
/// in parallel.

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>
#include <polemcl/mrpt/observation/CObservationPoles.h>
#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include "core/common/Deskew.h"
#include "io/data/PlanarMotion.h"
#include "mrpt/rawlog/MotionOptions.h"
#include "mrpt/rawlog/UntoldTurn.h"
#include "mrpt/rawlog/VehicleOptions.h"

namespace polemcl {

class EntrySource;

/// \brief Clock for measuring latencies.
using ScanClock = std::chrono::steady_clock;

struct SequenceOptions {
  ObservationPoleExtractorOptions extraction;
  MotionOptions motion;
  bool allowTruncated = false;
  double follow = 0;  ///< s; reading ends when a rawlog has not grown for this time
  int threads = 0;    ///< extracting, at most one per core; 0: that many. The result is the same
  /// Sets the pace of the input. Called in order with the time (s) of each scan that has been read,
  /// from one thread at a time; may wait while `goesOn` gives true. Returns the moment at which the
  /// scan counts as there. Empty: no scan waits.
  std::function<ScanClock::time_point(double, const std::function<bool()>& goesOn)> pace = {};
  /// Several LiDARs; with none, `extraction` holds for the one that is used.
  VehicleOptions vehicle = {};
  /// Velocity of the robot at a time (s), where it is known better than from the odometry; may be
  /// called from several threads. Several LiDARs measure a pole at different moments.
  std::function<Velocity(double)> velocity = {};
};

/// \brief What became of the scans of one LiDAR of several.
struct LidarCounts {
  std::string label;
  std::size_t scans = 0;    ///< used
  std::size_t missing = 0;  ///< fused scans without one of this LiDAR
  std::size_t late = 0;     ///< dropped: they came after later scans had been fused
  std::size_t shared = 0;   ///< its poles that LiDARs listed before it saw as well
  double apart = 0;         ///< rms distance between the places of those poles, m
  double apartSigmas = 0;   ///< rms, in standard deviations of each axis; 1 is expected
};

/// \brief Statistics of the rawlog.
struct SequenceCounts {
  std::size_t scans = 0;           ///< scans returned, including empty ones
  std::size_t storedScans = 0;     ///< scans that were stored as poles in the rawlog
  bool storedTurn = false;         ///< their poles say when in a turn they were measured
  std::size_t emptyScans = 0;      ///< scans without valid points and poles
  std::size_t unorderedScans = 0;  ///< without poles: ObservationPoleExtractor::UnorderedScan
  std::size_t points = 0;          ///< valid points of all scans
  std::size_t invalidPoints = 0;   ///< points dropped: NaN, infinite or at the origin
  std::size_t poles = 0;
  std::size_t otherSensors = 0;              ///< ignored scans of other sensors
  std::set<std::string> otherLabels = {};    ///< class and sensor label of those
  std::set<std::string> otherOdometry = {};  ///< labels of odometry that is not used
  std::vector<LidarCounts> lidars = {};      ///< as in VehicleOptions; empty if none was fused
  std::map<std::string, UntoldTurn> untoldTurns = {};  ///< by sensor label
  std::size_t unknownMotions = 0;  ///< scans without odometry: after the first one; of sensors,
                                   ///< these are left out
  std::size_t dropped = 0;         ///< scans of sensors that nobody had time for
  std::size_t lostPackets = 0;     ///< of LiDARs, missing in their scans
  std::size_t ignoredPackets = 0;  ///< of other things than those LiDARs
  std::size_t odometryJumps = 0;   ///< steps of the odometry that no vehicle makes, bridged by
                                   ///< the motion before
  bool truncated = false;          ///< the file is truncated, and this was allowed
  std::string failure = {};        ///< why a drive from sensors ended before its time; or empty
};

/// \brief One scan from the stream.
struct ReadScan {
  std::size_t index = 0;  ///< 0-based among the scans of the rawlog
  double time = 0;        ///< time of the observation, s
  /// Motion since the previous scan, in its robot frame. Identity without covariance for the first
  /// scan; nullopt if the rawlog has no odometry in between.
  std::optional<PoseWithCovariance> motion;
  /// Velocity at the time of the scan, where it is known better than from the motion before. The
  /// first scan has the velocity on the way to the second. Odometry readings around a scan also
  /// give it.
  std::optional<Velocity> velocity;
  CObservationPoles::Ptr observation;  ///< never null
  /// Sources of the poles; their points may still be in external files. Several if LiDARs were
  /// fused; none of stored poles.
  std::vector<mrpt::obs::CObservation::Ptr> sources;
  std::size_t points = 0;   ///< valid points; 0 if stored poles do not state it
  std::size_t invalid = 0;  ///< dropped points
  ExtractionReport report;  ///< report of the extraction; all zero for stored poles
  bool stored = false;      ///< true: read as poles, not extracted
  /// Time when the scan was read, due by SequenceOptions::pace, or given by its sensor.
  ScanClock::time_point arrival;
  double readSeconds = 0;         ///< time spent on reading it; of sensors: the wait since arrival
  double extractSeconds = 0;      ///< time spent on loading points and extracting poles
  std::size_t dropped = 0;        ///< scans of sensors that were dropped before this one, in all
  std::size_t odometryJumps = 0;  ///< before this scan was read, in all
  /// Estimated number of scans in the rawlog, from the fraction of the file read so far; 0:
  /// unknown.
  std::size_t expected = 0;
};

/// \brief Called with the number of finished scans and the expected total (0: unknown).
using ScanProgress = std::function<void(std::size_t done, std::size_t total)>;

/// \brief Streams a rawlog: reads in order, extracts on several threads, returns scans in order. At
/// most a few scans per thread are in memory.
///
/// Scans are the observations that ObservationPoleExtractor can process, and CObservationPoles.
/// Only those with the class and sensor label of the first one are used; if the first frame holds
/// poles and other scans, the poles are used. If SequenceOptions::vehicle lists LiDARs, their scans
/// are used instead, and those that belong together become one scan of the robot: its label is
/// `fused`, its sensor pose the identity, its time that of the latest of them. Such scans of stored
/// poles are read as they are. External files with relative names are searched in
/// `<rawlog>_Images` if it exists, otherwise beside the rawlog. (MRPT has one such folder for the
/// whole program.)
///
/// Motions come from the action before the frame; several actions are composed. For `emOdometry`
/// the stored reading is used, with the covariance of the Gaussian model or, without one, that of
/// `[motion]`. Without actions, motions come from CObservationOdometry with the covariance of
/// `[motion]`. Its readings are interpolated at the time of the scan (the first and last are valid
/// for another 0.5 s).
///
/// The next scans are read and extracted while a scan is consumed. An error ends the stream at its
/// position: all scans before it have been returned.
/// \param consume Called in order and never twice at once, but from changing threads: it needs no
/// lock, and must not rely on thread-local state (an OpenGL context, `thread_local`).
/// \throws Error as RawlogReader and ObservationPoleExtractor do, with file and scan; when a LiDAR
///         of SequenceOptions::vehicle is not in the rawlog. Exceptions of `consume` are passed on.
POLEMCL_EXPORT SequenceCounts streamPoles(const std::string& path, const SequenceOptions& options,
                                          const std::function<void(const ReadScan&)>& consume);

/// \brief As streamPoles() of a rawlog. Scans of sensors have the time of their arrival; one
/// without odometry at its time is left out, and the motion goes on to the next.
/// \param name The source, for messages.
/// \param options `pace`, `allowTruncated` and `follow` have no effect on sensors.
/// \return For sensors also why the drive ended, after its first scan: `failure`.
/// \throws Error as streamPoles(); when no odometry came with many scans of sensors.
SequenceCounts streamPoles(std::shared_ptr<EntrySource> entries, const std::string& name,
                           const SequenceOptions& options,
                           const std::function<void(const ReadScan&)>& consume);

/// \brief Reduces a scan to what map and filter need: of its poles at most `mostDetections`, the
/// most confident. \param scan From streamPoles().
POLEMCL_EXPORT PoleScan frameOf(const ReadScan& scan);
/// \brief The same from an observation that comes from elsewhere: from a sensor through
/// ObservationPoleExtractor::process(), or from a rawlog that the caller reads.
/// \param motion Since the scan before, in its robot frame; nullopt: not known, which is right for
/// the first scan only. `points` and `velocity` of the frame stay unknown.
POLEMCL_EXPORT PoleScan frameOf(const CObservationPoles& observation,
                                const std::optional<PoseWithCovariance>& motion);

struct PoleSequence {
  std::vector<PoleScan> frames;
  SequenceCounts counts;
};

/// \brief Reads a whole rawlog, poles only.
/// \param progress May be empty.
/// \throws Error as streamPoles().
POLEMCL_EXPORT PoleSequence readPoleSequence(const std::string& path,
                                             const SequenceOptions& options,
                                             const ScanProgress& progress = {});

}  // namespace polemcl
