#include "localize/LiveDrive.h"

#include <mrpt/obs/CObservationOdometry.h>

#include <atomic>
#include <mutex>

#include "cli/Progress.h"
#include "io/file/InstalledFiles.h"
#include "io/file/TextFile.h"
#include "mrpt/live/LiveQueue.h"
#include "mrpt/live/LiveSensors.h"
#include "mrpt/rawlog/EntrySource.h"
#include "mrpt/rawlog/RawlogWriter.h"
#include "mrpt/rawlog/ScanSource.h"

namespace polemcl::apps {
namespace {

/// Notices that nothing is consumed, and says what the sensors do not give.
class GapWatch {
 public:
  explicit GapWatch(const LiveDriveOptions& drive) : m_drive(drive) {}

  void observed(const mrpt::obs::CObservation& observation) {
    if (isScan(observation))
      m_scan = Clock::now();
    else if (dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation))
      m_odometry = Clock::now();
  }
  void consume(const ReadScan& scan, const std::function<void(const ReadScan&)>& consume) {
    setBusy(true);
    consume(scan);
    setBusy(false);
  }
  /// Called every few milliseconds. A gap is told before the scan that ends it is consumed.
  void look() {
    const std::lock_guard lock(m_mutex);
    if (m_isBusy || secondsSince(m_told) < m_drive.longestGap) return;
    m_told = Clock::now();
    if (m_drive.gap) m_drive.gap();
    if (!m_isWarned && m_drive.warn) m_drive.warn(text());
    m_isWarned = true;
  }

 private:
  using Clock = std::chrono::steady_clock;
  void setBusy(bool isBusy) {
    const std::lock_guard lock(m_mutex);
    m_isBusy = isBusy;
    m_isWarned = false;
    m_told = Clock::now();
  }
  std::string text() const {
    const std::string time = " for " + io::fixed(m_drive.longestGap, 1) + " s";
    const std::string file = m_drive.sensors.string() + ": ";
    const double silent = m_drive.longestGap / 2;  // not all fall silent at the same moment
    const bool noScan = secondsSince(m_scan) >= silent;
    const bool noOdometry = secondsSince(m_odometry) >= silent;
    if (noScan && noOdometry) return file + "no scan and no odometry" + time;
    if (noScan) return file + "no scan" + time;
    if (noOdometry) return file + "no odometry" + time + ": scans without it are left out";
    return file + "no scan has odometry of its time" + time + ": check the clocks";
  }

  const LiveDriveOptions& m_drive;
  std::atomic<Clock::time_point> m_scan{Clock::now()}, m_odometry{Clock::now()};
  std::mutex m_mutex;  ///< of all below
  Clock::time_point m_told = Clock::now();
  bool m_isBusy = false, m_isWarned = false;
};

/// The entries of another source, each written to a rawlog before it is handed out: in the
/// order and with the times that the localization sees. Scans that were dropped are not among them.
class RecordedEntries : public EntrySource {
 public:
  /// \param source Of observations. \throws Error when the rawlog cannot be written.
  RecordedEntries(std::shared_ptr<EntrySource> source, const std::string& rawlog)
      : m_source(std::move(source)), m_writer(rawlog) {}

  bool next(RawlogEntry& entry) override {
    if (!m_source->next(entry)) return false;
    if (entry.observation) m_writer.write(*entry.observation);
    return true;
  }
  void stop() override { m_source->stop(); }
  bool isLive() const override { return m_source->isLive(); }
  const std::string& comment() const override { return m_source->comment(); }
  std::size_t dropped() const override { return m_source->dropped(); }

  /// Gives the rawlog its name. \throws Error when a write failed.
  void commit() { m_writer.commit(); }

 private:
  std::shared_ptr<EntrySource> m_source;
  RawlogWriter m_writer;
};

std::atomic<bool> s_came{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set by a signal handler");

void note(int) {
  s_came = true;
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace

EndSignals::EndSignals() {
  s_came = false;
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, &m_interrupt);
  sigaction(SIGTERM, &action, &m_terminate);
}

EndSignals::~EndSignals() {
  sigaction(SIGINT, &m_interrupt, nullptr);
  sigaction(SIGTERM, &m_terminate, nullptr);
}

bool EndSignals::came() {
  return s_came;
}

LiveDriveResult streamSensors(const LiveDriveOptions& drive, const SequenceOptions& options,
                              const std::function<void(const ReadScan&)>& consume) {
  GapWatch watch(drive);
  LiveQueueOptions queueOptions;
  queueOptions.goesOn = [&] {
    watch.look();
    return !drive.goesOn || drive.goesOn();
  };
  queueOptions.warn = drive.warn;
  for (const LidarOptions& lidar : options.vehicle.lidars)
    queueOptions.lidars.push_back(lidar.label);
  const auto queue = std::make_shared<LiveQueue>(queueOptions);
  std::atomic<std::size_t> lostPackets{0}, ignoredPackets{0};
  const auto sensors = startSensors(io::installedFile(drive.sensors, "config").string(),
                                    {[&](const mrpt::obs::CObservation::Ptr& observation) {
                                       watch.observed(*observation);
                                       queue->push(observation);
                                     },
                                     [&](const std::string& failure) { queue->end(failure); },
                                     [&](const std::string& warning) {
                                       if (drive.warn) drive.warn(warning);
                                     },
                                     [&](std::size_t lost, std::size_t ignored) {
                                       lostPackets += lost;
                                       ignoredPackets += ignored;
                                     }});
  const auto record =
      drive.record ? std::make_shared<RecordedEntries>(queue, drive.record->string()) : nullptr;
  LiveDriveResult result;
  result.counts = streamPoles(record ? std::static_pointer_cast<EntrySource>(record) : queue,
                              drive.sensors.string(), options,
                              [&](const ReadScan& scan) { watch.consume(scan, consume); });
  result.counts.lostPackets = lostPackets;
  result.counts.ignoredPackets = ignoredPackets;
  result.failure = result.counts.failure.empty() ? queue->failure() : result.counts.failure;
  if (record) keep(*record, result.failure);
  if (!result.failure.empty() && result.counts.scans == 0) throw Error(result.failure);
  return result;
}

}  // namespace polemcl::apps
