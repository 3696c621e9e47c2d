#pragma once
/// \file LiveDrive.h
/// \brief A drive that is not recorded: scans straight from the sensors, until a signal ends it.
/// Private to the library.

#include <csignal>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include <polemcl/core/common/Types.h>
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl::apps {

/// \brief While it lives, the first SIGINT or SIGTERM only sets a flag; a second one, of either,
/// ends the program at once. Only one at a time.
class EndSignals {
 public:
  EndSignals();
  ~EndSignals();
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

  /// \brief Whether one has come. From any thread.
  static bool came();

 private:
  struct sigaction m_interrupt, m_terminate;
};

struct LiveDriveOptions {
  std::filesystem::path sensors;  ///< see startSensors(); also a name among the shipped ones
  std::optional<std::filesystem::path> record = {};  ///< rawlog of what is taken from the sensors
  double longestGap = 2;                             ///< more time without a scan is told, s
  std::function<bool()> goesOn = {};  ///< false ends the drive; called from one thread at a time
  /// Called after each `longestGap` without a scan, also before the first one. May be called while
  /// a scan is consumed.
  std::function<void()> gap = {};
  /// What is not right but does not end the drive. From any thread.
  std::function<void(const std::string&)> warn = {};
};

struct LiveDriveResult {
  SequenceCounts counts;
  std::string failure;  ///< what ended the drive before its time; or empty
};

/// \brief Streams poles from sensors until `goesOn` gives false, the end of a PCAP file, or the
/// failure of a sensor.
///
/// The record gives the same poses when it is played. It is kept whatever ends the drive; when it
/// cannot be written, that is a failure.
/// Scans that come faster than `consume` takes them are dropped, the oldest first, see LiveQueue.
/// \throws Error as startSensors() and streamPoles(); the failure of a sensor before any scan.
LiveDriveResult streamSensors(const LiveDriveOptions& drive, const SequenceOptions& options,
                              const std::function<void(const ReadScan&)>& consume);

/// \brief Commits what came of a drive. That it cannot be written is a failure, unless there is one
/// already.
template <class Record>
void keep(Record& record, std::string& failure) {
  try {
    record.commit();
  } catch (const Error& error) {
    if (failure.empty()) failure = error.what();
  }
}

}  // namespace polemcl::apps
