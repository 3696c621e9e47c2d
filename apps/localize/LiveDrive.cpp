#include "localize/LiveDrive.h"

#include <atomic>
#include <csignal>

#include "cli/Progress.h"
#include "io/file/InstalledFiles.h"
#include "mrpt/live/LiveQueue.h"
#include "mrpt/live/LiveSensors.h"
#include "mrpt/rawlog/EntryStream.h"

namespace polemcl::apps {
namespace {

std::atomic<bool> s_signalled{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set by a signal handler");

/// Takes the signals that end the program as the wish to end the drive, once each.
class EndSignals {
 public:
  EndSignals() {
    s_signalled = false;
    struct sigaction action {};
    action.sa_handler = [](int) { s_signalled = true; };
    action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
    sigaction(SIGINT, &action, &m_interrupt);
    sigaction(SIGTERM, &action, &m_terminate);
  }
  ~EndSignals() {
    sigaction(SIGINT, &m_interrupt, nullptr);
    sigaction(SIGTERM, &m_terminate, nullptr);
  }
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

 private:
  struct sigaction m_interrupt, m_terminate;
};

}  // namespace

LiveDriveResult streamSensors(const LiveDriveOptions& drive, const SequenceOptions& options,
                              const std::function<void(const PoleScan&)>& consume) {
  const EndSignals signals;
  const auto begin = ScanClock::now();
  LiveQueueOptions queueOptions;
  queueOptions.goesOn = [&] {
    return !s_signalled && !(drive.seconds > 0 && secondsSince(begin) >= drive.seconds);
  };
  for (const LidarOptions& lidar : options.vehicle.lidars)
    queueOptions.lidars.push_back(lidar.label);
  const auto queue = std::make_shared<LiveQueue>(queueOptions);
  const auto sensors = startSensors(
      io::installedFile(drive.sensors, "config").string(),
      {[&](const mrpt::obs::CObservation::Ptr& observation) { queue->push(observation); },
       [&](const std::string& failure) { queue->end(failure); }});
  LiveDriveResult result;
  result.counts = streamPoles(queue, drive.sensors.string(), options, consume);
  result.failure = queue->failure();
  if (!result.failure.empty() && result.counts.scans == 0) throw Error(result.failure);
  return result;
}

}  // namespace polemcl::apps
