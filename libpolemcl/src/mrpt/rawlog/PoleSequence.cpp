#include "mrpt/rawlog/PoleSequence.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <map>

#include "core/common/DetectionCheck.h"
#include "mrpt/observation/LidarFrame.h"
#include "mrpt/observation/ScanFusion.h"
#include "mrpt/rawlog/EntrySource.h"
#include "mrpt/rawlog/ScanSource.h"

namespace polemcl {

namespace {

double secondsSince(ScanClock::time_point begin) {
  return std::chrono::duration<double>(ScanClock::now() - begin).count();
}

/// Scans of each LiDAR that are compared with the settings; these must be in order, too.
constexpr std::size_t kChecked = 3;

CObservationPoles::Ptr noPolesOf(const mrpt::obs::CObservation& scan) {
  auto none = std::make_shared<CObservationPoles>();
  none->timestamp = scan.timestamp;
  none->sensorLabel = scan.sensorLabel;
  scan.getSensorPose(none->sensorPose);
  return none;
}

/// Files may hold any numbers.
void requirePose(const CObservationPoles& stored) {
  if (!isPose(stored.sensorPose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen()))
    throw Error(
        "the sensor pose of its poles is not a finite place and a rotation; extract the poles "
        "again");
}

/// One scan in the pipeline. An error travels in the scan's position: the first error of the file
/// is thus the one reported, for any timing of the threads.
struct Task {
  ScanSource::Scan scan;
  ScanTiming timing;  ///< as the rawlog states it
  ReadScan result;
  std::vector<FusionAgreement> agreements;  ///< of the parts, if LiDARs are fused
  /// Order of the points by sensor label, for UntoldTurnSearch.
  std::map<std::string, std::optional<PointOrder>> orders;
  bool isUnordered = false;  ///< no poles: ObservationPoleExtractor::UnorderedScan
  std::exception_ptr error;
};
using TaskPtr = std::shared_ptr<Task>;

class Stream {
 public:
  Stream(ScanSource& source, const std::string& name, const SequenceOptions& options)
      : m_name(name),
        m_pace(options.pace),
        m_source(source),
        m_velocity(options.velocity),
        m_extractions([options] { return extractorsFor(options); }) {
    m_extractions.local();  // reports invalid options here, for any rawlog
    for (const LidarOptions& lidar : options.vehicle.lidars) {
      m_lidars.push_back({lidar.label});
      m_sensors.push_back(lidar.sensor);
    }
    if (m_sensors.empty()) m_sensors.push_back(options.extraction.sensor);
  }

  TaskPtr read();
  void extract(Task& task);
  void collect(Task& task, const std::function<void(const ReadScan&)>& consume);
  /// \brief After the pipeline. \throws What went wrong first.
  SequenceCounts finish() const;

 private:
  using Extractors = std::vector<ObservationPoleExtractor>;
  static Extractors extractorsFor(const SequenceOptions& options);
  CObservationPoles::Ptr polesOf(const LidarScan& part, Task& task);
  void fuse(Task& task, const std::vector<CObservationPoles::Ptr>& parts) const;
  void count(const ReadScan& scan, bool isUnordered);
  void countLidars(const Task& task);
  /// What the settings say of a LiDAR.
  const ScanTiming& timingOf(const std::string& label) const;

  std::string m_name;
  decltype(SequenceOptions::pace) m_pace;
  ScanSource& m_source;
  std::function<Velocity(double)> m_velocity;
  tbb::enumerable_thread_specific<Extractors> m_extractions;  ///< one for each LiDAR
  std::vector<SensorOptions> m_sensors;                       ///< of each LiDAR
  std::map<std::string, UntoldTurnSearch> m_turns;            ///< by sensor label
  std::vector<LidarCounts> m_lidars;  ///< sums of squares in `apart`, `apartSigmas`
  SequenceCounts m_counts;
  bool m_ended = false;
  std::atomic<bool> m_failed{false};
  std::exception_ptr m_failure;  ///< set before m_failed
};

/// The next scan, or the error at its position; null at the end.
TaskPtr Stream::read() {
  if (m_ended || m_failed) return nullptr;
  auto task = std::make_shared<Task>();
  try {
    const auto begin = ScanClock::now();
    auto scan = m_source.next();
    m_ended = !scan;
    if (m_ended) return nullptr;
    task->scan = std::move(*scan);
    task->timing = m_source.timing();
    task->result.expected = m_source.expected();
    const auto& arrival = task->scan.arrival;
    task->result.readSeconds = secondsSince(arrival ? *arrival : begin);
    task->result.dropped = task->scan.dropped;
    task->result.odometryJumps = m_source.odometryJumps();
    const auto due = [&](double time) {
      return m_pace ? m_pace(time, [this] { return !m_failed; }) : ScanClock::now();
    };
    task->result.arrival = arrival ? *arrival : due(task->scan.time);
  } catch (...) {
    m_ended = true;
    task->error = std::current_exception();
  }
  return task;
}

/// Without named LiDARs, there is one.
Stream::Extractors Stream::extractorsFor(const SequenceOptions& options) {
  Extractors extractors;
  for (const LidarOptions& lidar : options.vehicle.lidars)
    extractors.emplace_back(lidar.extractor());
  if (extractors.empty()) extractors.emplace_back(options.extraction);
  return extractors;
}

/// The poles of one LiDAR's scan; adds to the report what the extraction did.
CObservationPoles::Ptr Stream::polesOf(const LidarScan& part, Task& task) {
  if (auto stored = std::dynamic_pointer_cast<CObservationPoles>(part.observation)) {
    requirePose(*stored);
    return stored;
  }
  ObservationPoleExtractor& extraction = m_extractions.local()[part.lidar];
  // By number, so that the result does not depend on the threads.
  extraction.setRecordedTiming(task.timing);
  extraction.checkNext(part.ordinal < kChecked);
  CObservationPoles::Ptr poles;
  try {
    poles = extraction.process(*part.observation);
  } catch (const ObservationPoleExtractor::UnorderedScan&) {
    if (part.ordinal < kChecked) throw;
    poles = noPolesOf(*part.observation);
    task.isUnordered = true;
  }
  task.result.sources.push_back(part.observation);
  task.result.report += extraction.report();
  if (UntoldTurnSearch::wants(part.ordinal))
    task.orders[part.observation->sensorLabel] =
        untoldOrder(*part.observation, m_sensors.at(part.lidar), task.timing);
  return poles;
}

void Stream::fuse(Task& task, const std::vector<CObservationPoles::Ptr>& parts) const {
  const double time = task.scan.time;
  const Velocity velocity = m_velocity ? m_velocity(time) : task.scan.moving.value_or(Velocity());
  FusedScan fused = fuseScans(parts, time, velocity);
  task.result.observation = fused.observation;
  task.agreements = std::move(fused.agreements);
}

void Stream::extract(Task& task) {
  if (task.error) return;
  ReadScan& result = task.result;
  result.index = task.scan.index;
  result.time = task.scan.time;
  result.motion = task.scan.motion;
  result.velocity = task.scan.velocity;
  const auto begin = ScanClock::now();
  std::vector<CObservationPoles::Ptr> parts;
  std::string label;
  try {
    for (const LidarScan& part : task.scan.parts) {
      if (task.scan.isFused) label = "LiDAR " + m_lidars[part.lidar].label + ": ";
      parts.push_back(polesOf(part, task));
    }
    if (task.scan.isFused)
      fuse(task, parts);
    else
      result.observation = parts.front();
  } catch (const std::exception& error) {
    task.error = std::make_exception_ptr(
        Error(m_name + ": scan " + std::to_string(task.scan.index) + ": " + label + error.what()));
    return;
  }
  result.stored = result.sources.empty();
  result.points = result.observation->points;
  result.invalid = result.report.invalid;
  if (!result.stored) result.extractSeconds = secondsSince(begin);
}

/// An exception must not leave the pipeline: TBB would lose the task that caused it.
void Stream::collect(Task& task, const std::function<void(const ReadScan&)>& consume) {
  if (m_failed) return;
  try {
    if (task.error) std::rethrow_exception(task.error);
    consume(task.result);
    count(task.result, task.isUnordered);
    if (task.scan.isFused) countLidars(task);
    for (const auto& [label, order] : task.orders) m_turns[label].add(order);
  } catch (...) {
    m_failure = std::current_exception();
    m_failed = true;
    m_source.stop();
  }
}

void Stream::count(const ReadScan& scan, bool isUnordered) {
  ++m_counts.scans;
  m_counts.storedScans += scan.stored ? 1 : 0;
  const std::vector<PoleDetection>& poles = scan.observation->poles;
  m_counts.storedTurn |= scan.stored && std::any_of(poles.begin(), poles.end(), [&](const auto& p) {
                           return p.timeOffset != poles.front().timeOffset;
                         });
  m_counts.unorderedScans += isUnordered ? 1 : 0;
  const bool isEmpty = scan.points == 0 && scan.observation->poles.empty();
  m_counts.emptyScans += isEmpty && !isUnordered ? 1 : 0;
  m_counts.points += scan.points;
  m_counts.invalidPoints += scan.invalid;
  m_counts.poles += poles.size();
}

void Stream::countLidars(const Task& task) {
  for (std::size_t i = 0; i < task.scan.parts.size(); ++i) {
    LidarCounts& lidar = m_lidars[task.scan.parts[i].lidar];
    ++lidar.scans;
    lidar.shared += task.agreements[i].poles;
    lidar.apart += task.agreements[i].squaredMetres;
    lidar.apartSigmas += task.agreements[i].squaredSigmas;
  }
}

std::string reasonOf(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const std::exception& error) {
    return error.what();
  }
}

const ScanTiming& Stream::timingOf(const std::string& label) const {
  for (std::size_t i = 0; i < m_lidars.size(); ++i)
    if (m_lidars[i].label == label) return m_sensors[i].timing;
  return m_sensors.front().timing;
}

SequenceCounts Stream::finish() const {
  SequenceCounts counts = m_counts;
  // A drive cannot be repeated: what came before the failure counts.
  if (m_failure && !(m_source.isLive() && counts.scans > 0)) std::rethrow_exception(m_failure);
  if (m_failure) counts.failure = reasonOf(m_failure);
  if (m_source.isFused()) counts.lidars = m_lidars;
  for (std::size_t i = 0; i < counts.lidars.size(); ++i) {
    LidarCounts& lidar = counts.lidars[i];
    lidar.missing = counts.scans - lidar.scans;
    lidar.late = m_source.late(i);
    if (lidar.shared == 0) continue;
    const auto poles = static_cast<double>(lidar.shared);
    lidar.apart = std::sqrt(lidar.apart / poles);
    lidar.apartSigmas = std::sqrt(lidar.apartSigmas / (2 * poles));
  }
  for (const auto& [label, turns] : m_turns)
    if (const auto found = turns.found(timingOf(label))) counts.untoldTurns.emplace(label, *found);
  counts.otherSensors = m_source.otherSensors();
  counts.otherLabels = m_source.otherLabels();
  counts.otherOdometry = m_source.otherOdometry();
  counts.unknownMotions = m_source.unknownMotions();
  counts.dropped = m_source.dropped();
  counts.odometryJumps = m_source.odometryJumps();
  counts.truncated = m_source.truncated();
  return counts;
}

void requireThreads(const SequenceOptions& options) {
  if (options.threads < 0)
    throw Error("threads = " + std::to_string(options.threads) + ": allowed is 0 or more");
}

SequenceCounts play(ScanSource& source, const std::string& name, const SequenceOptions& options,
                    const std::function<void(const ReadScan&)>& consume) {
  Stream stream(source, name, options);
  const int cores = tbb::info::default_concurrency();  // TBB rejects more threads than that
  const int threads = options.threads > 0 ? std::min(options.threads, cores) : cores;
  tbb::task_arena arena(threads);
  arena.execute([&] {
    const auto read = [&](tbb::flow_control& control) {
      TaskPtr task = stream.read();
      if (!task) control.stop();
      return task;
    };
    const auto extract = [&](TaskPtr task) {
      stream.extract(*task);
      return task;
    };
    const auto collect = [&](const TaskPtr& task) { stream.collect(*task, consume); };
    // Scans of sensors that must wait do so where the oldest can be dropped, not in here.
    const auto atOnce = static_cast<std::size_t>(source.isLive() ? threads + 1 : 2 * threads);
    tbb::parallel_pipeline(
        atOnce, tbb::make_filter<void, TaskPtr>(tbb::filter_mode::serial_in_order, read) &
                    tbb::make_filter<TaskPtr, TaskPtr>(tbb::filter_mode::parallel, extract) &
                    tbb::make_filter<TaskPtr, void>(tbb::filter_mode::serial_in_order, collect));
  });
  return stream.finish();
}

}  // namespace

SequenceCounts streamPoles(const std::string& path, const SequenceOptions& options,
                           const std::function<void(const ReadScan&)>& consume) {
  requireThreads(options);
  ScanSource source(path, options.motion, options.allowTruncated, options.follow, options.vehicle);
  return play(source, path, options, consume);
}

SequenceCounts streamPoles(std::shared_ptr<EntrySource> entries, const std::string& name,
                           const SequenceOptions& options,
                           const std::function<void(const ReadScan&)>& consume) {
  requireThreads(options);
  ScanSource source(std::move(entries), name, options.motion, options.vehicle);
  return play(source, name, options, consume);
}

PoleScan frameOf(const CObservationPoles& observation,
                 const std::optional<PoseWithCovariance>& motion) {
  PoleScan frame;
  frame.time = mrpt::Clock::toDouble(observation.timestamp);
  frame.motion = motion;
  frame.poles_robot = observation.polesInRobotFrame();
  keepMostConfident(frame.poles_robot);
  frame.visibilityRange = observation.visibilityRange;
  frame.pose_robot_sensor = observation.planarSensorPose();
  return frame;
}

PoleScan frameOf(const ReadScan& scan) {
  PoleScan frame = frameOf(*scan.observation, scan.motion);
  frame.time = scan.time;
  frame.points = scan.points;
  frame.velocity = scan.velocity;
  return frame;
}

PoleSequence readPoleSequence(const std::string& path, const SequenceOptions& options,
                              const ScanProgress& progress) {
  PoleSequence sequence;
  sequence.counts = streamPoles(path, options, [&](const ReadScan& scan) {
    sequence.frames.push_back(frameOf(scan));
    if (progress) progress(sequence.frames.size(), scan.expected);
  });
  return sequence;
}

}  // namespace polemcl
