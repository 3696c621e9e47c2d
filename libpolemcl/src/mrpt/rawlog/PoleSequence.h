#pragma once
/// \file PoleSequence.h
/// \brief A rawlog of scans or of poles, as poles with the motions between them; extracted in
/// parallel.

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/data/PlanarMotion.h"
#include "mrpt/observation/CObservationPoles.h"
#include "mrpt/observation/ObservationPoleExtractor.h"
#include "mrpt/rawlog/MotionOptions.h"

namespace polemcl {

/// \brief The clock by which latencies are measured.
using ScanClock = std::chrono::steady_clock;

struct SequenceOptions {
  ObservationPoleExtractorOptions extraction;
  MotionOptions motion;
  bool allowTruncated = false;
  int threads = 0;  ///< extracting, at most one per core; 0: that many. The result is the same
  /// Sets the pace of the input. Called in order with the time (s) of each scan that has been read,
  /// from one thread at a time; may wait. Returns the moment at which the scan counts as there.
  /// Empty: no scan waits.
  std::function<ScanClock::time_point(double)> pace = {};
};

/// \brief What was in the rawlog.
struct SequenceCounts {
  std::size_t scans = 0;          ///< given out, empty ones included
  std::size_t storedScans = 0;    ///< of these, poles that were read as they are
  std::size_t emptyScans = 0;     ///< without a valid point (and no poles either)
  std::size_t points = 0;         ///< valid points, all scans
  std::size_t invalidPoints = 0;  ///< NaN, infinite or at the sensor: dropped
  std::size_t poles = 0;
  std::size_t otherSensors = 0;    ///< scans of another sensor label than the first's: not used
  std::size_t unknownMotions = 0;  ///< scans after the first without any odometry
  bool truncated = false;          ///< the file ended too early, and that was allowed
};

/// \brief One scan as it comes out of the stream.
struct PoleScan {
  std::size_t index = 0;  ///< 0-based among the scans of the rawlog
  double time = 0;        ///< s, of the observation
  /// Since the scan before, in its robot frame; identity without covariance for the first; none
  /// when the rawlog has no odometry in between.
  std::optional<io::PlanarMotion> motion;
  CObservationPoles::Ptr observation;  ///< never null
  /// What the poles were extracted from, its points maybe outside still; null for stored poles.
  mrpt::obs::CObservation::Ptr scan;
  std::size_t points = 0;         ///< valid points; 0 for stored poles that do not tell
  std::size_t invalid = 0;        ///< dropped points
  ExtractionReport report;        ///< of the extraction; all zero for stored poles
  bool stored = false;            ///< true: read as poles, not extracted
  ScanClock::time_point arrival;  ///< when it was there: read, or due by SequenceOptions::pace
  double readSeconds = 0;         ///< spent on reading it
  double extractSeconds = 0;      ///< spent on its points and poles
  /// Scans of the whole rawlog, judged from the share of the file read so far; 0: not known yet.
  std::size_t expected = 0;
};

/// \brief Called with the scans done so far and those expected in all, 0: not known.
using ScanProgress = std::function<void(std::size_t done, std::size_t total)>;

/// \brief Streams a rawlog: reads in order, extracts on several threads, hands out in order. At
/// most a few scans per thread are in memory.
///
/// Scans are the observations that ObservationPoleExtractor can process, and CObservationPoles; all
/// of the class and sensor label that come first (of a frame that holds both, the poles). External
/// files with relative names are looked for in `<rawlog>_Images` if there is one, else beside the
/// rawlog (MRPT keeps one such folder for the whole program). Motions: the action before the frame
/// (for `emOdometry` the stored reading; its covariance is the Gaussian model's if it has one, else
/// `[motion]`'s), several actions composed; else CObservationOdometry, interpolated at the time of
/// the scan (held for 0.5 s before the first and after the last reading), covariance from
/// `[motion]`.
///
/// While a scan is extracted and consumed, the next ones are read and extracted.
///
/// An error ends the stream in its place: the scans before it have been handed out.
/// \param consume Called in order, from one thread at a time.
/// \throws Error as RawlogReader and ObservationPoleExtractor do, naming file and scan; and what
/// consume throws.
SequenceCounts streamPoles(const std::string& path, const SequenceOptions& options,
                           const std::function<void(const PoleScan&)>& consume);

/// \brief One scan, ready for map and filter.
struct PoleFrame {
  double time = 0;                         ///< s
  std::optional<io::PlanarMotion> motion;  ///< as in PoleScan
  std::vector<PoleDetection> poles_robot;
  std::size_t points = 0;                   ///< valid points of the scan; 0: none, or not known
  std::vector<float> visibilityRange = {};  ///< as CObservationPoles carries it; maybe empty
  Pose2D pose_robot_sensor = {};            ///< of the frame of visibilityRange
};

/// \brief What map and filter need of a scan. \param scan Of streamPoles().
PoleFrame frameOf(const PoleScan& scan);

struct PoleSequence {
  std::vector<PoleFrame> frames;
  SequenceCounts counts;
};

/// \brief All of a rawlog, poles only.
/// \param progress May be empty.
/// \throws Error as streamPoles().
PoleSequence readPoleSequence(const std::string& path, const SequenceOptions& options,
                              const ScanProgress& progress = {});

}  // namespace polemcl
