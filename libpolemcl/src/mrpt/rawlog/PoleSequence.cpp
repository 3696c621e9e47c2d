#include <tbb/enumerable_thread_specific.h>
#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>

#include <polemcl/mrpt/rawlog/PoleSequence.h>
#include "mrpt/rawlog/EntryStream.h"
#include "mrpt/rawlog/ScanSource.h"

namespace polemcl {

namespace {

double secondsSince(ScanClock::time_point begin) {
  return std::chrono::duration<double>(ScanClock::now() - begin).count();
}

/// One scan in the pipeline. An error travels in the scan's position: the first error of the file
/// is thus the one reported, for any timing of the threads.
struct Task {
  ScanSource::Scan scan;
  ScanTiming timing;  ///< as the rawlog states it
  PoleScan result;
  std::exception_ptr error;
};
using TaskPtr = std::shared_ptr<Task>;

class Stream {
 public:
  Stream(ScanSource& source, const std::string& name, const SequenceOptions& options)
      : m_name(name),
        m_pace(options.pace),
        m_source(source),
        m_extractions([options] { return ObservationPoleExtractor(options.extraction); }) {
    m_extractions.local();  // reports invalid options here, for any rawlog
  }

  TaskPtr read();
  void extract(Task& task);
  void collect(Task& task, const std::function<void(const PoleScan&)>& consume);
  /// \brief After the pipeline. \throws What went wrong first.
  SequenceCounts finish() const;

 private:
  void count(const PoleScan& scan);

  std::string m_name;
  std::function<ScanClock::time_point(double)> m_pace;
  ScanSource& m_source;
  tbb::enumerable_thread_specific<ObservationPoleExtractor> m_extractions;
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
    task->result.arrival = arrival ? *arrival : m_pace ? m_pace(task->scan.time) : ScanClock::now();
  } catch (...) {
    m_ended = true;
    task->error = std::current_exception();
  }
  return task;
}

void Stream::extract(Task& task) {
  if (task.error) return;
  const auto observation = std::move(task.scan.observation);
  PoleScan& result = task.result;
  result.index = task.scan.index;
  result.time = task.scan.time;
  result.motion = task.scan.motion;
  result.velocity = task.scan.velocity;
  result.observation = std::dynamic_pointer_cast<CObservationPoles>(observation);
  result.stored = result.observation != nullptr;
  if (result.stored) {
    result.points = result.observation->points;
    return;
  }
  const auto begin = ScanClock::now();
  try {
    ObservationPoleExtractor& extraction = m_extractions.local();
    // By index, so that the result does not depend on the threads.
    extraction.setRecordedTiming(task.timing);
    extraction.checkNext(task.scan.index < 3);
    result.observation = extraction.process(*observation);
    result.scan = observation;
    result.points = result.observation->points;
    result.report = extraction.report();
    result.invalid = result.report.invalid;
    result.extractSeconds = secondsSince(begin);
  } catch (const std::exception& error) {
    task.error = std::make_exception_ptr(
        Error(m_name + ": scan " + std::to_string(task.scan.index) + ": " + error.what()));
  }
}

/// An exception must not leave the pipeline: TBB would lose the task that caused it.
void Stream::collect(Task& task, const std::function<void(const PoleScan&)>& consume) {
  if (m_failed) return;
  try {
    if (task.error) std::rethrow_exception(task.error);
    count(task.result);
    consume(task.result);
  } catch (...) {
    m_failure = std::current_exception();
    m_failed = true;
  }
}

void Stream::count(const PoleScan& scan) {
  ++m_counts.scans;
  m_counts.storedScans += scan.stored ? 1 : 0;
  m_counts.emptyScans += scan.points == 0 && scan.observation->poles.empty() ? 1 : 0;
  m_counts.points += scan.points;
  m_counts.invalidPoints += scan.invalid;
  m_counts.poles += scan.observation->poles.size();
}

SequenceCounts Stream::finish() const {
  if (m_failure) std::rethrow_exception(m_failure);
  SequenceCounts counts = m_counts;
  counts.otherSensors = m_source.otherSensors();
  counts.unknownMotions = m_source.unknownMotions();
  counts.dropped = m_source.dropped();
  counts.truncated = m_source.truncated();
  return counts;
}

void requireThreads(const SequenceOptions& options) {
  if (options.threads < 0)
    throw Error("threads = " + std::to_string(options.threads) + ": allowed is 0 or more");
}

SequenceCounts play(ScanSource& source, const std::string& name, const SequenceOptions& options,
                    const std::function<void(const PoleScan&)>& consume) {
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
                           const std::function<void(const PoleScan&)>& consume) {
  requireThreads(options);
  ScanSource source(path, options.motion, options.allowTruncated, options.follow);
  return play(source, path, options, consume);
}

SequenceCounts streamPoles(std::shared_ptr<EntrySource> entries, const std::string& name,
                           const SequenceOptions& options,
                           const std::function<void(const PoleScan&)>& consume) {
  requireThreads(options);
  ScanSource source(std::move(entries), name, options.motion);
  return play(source, name, options, consume);
}

PoleFrame frameOf(const PoleScan& scan) {
  return {scan.time,
          scan.motion,
          scan.observation->polesInRobotFrame(),
          scan.points,
          scan.observation->visibilityRange,
          scan.observation->planarSensorPose(),
          scan.velocity};
}

PoleSequence readPoleSequence(const std::string& path, const SequenceOptions& options,
                              const ScanProgress& progress) {
  PoleSequence sequence;
  sequence.counts = streamPoles(path, options, [&](const PoleScan& scan) {
    sequence.frames.push_back(frameOf(scan));
    if (progress) progress(sequence.frames.size(), scan.expected);
  });
  return sequence;
}

}  // namespace polemcl
