#pragma once
/// \file FaultTrials.h
/// \brief `pole-eval faults`: does the localization notice that something is wrong, and recover?

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "eval/FaultInjection.h"

namespace polemcl::apps {

struct FaultTrialsOptions {
  TrialDriveFiles files;
  std::optional<std::filesystem::path> otherMap;  ///< of wrongMap
  FaultOptions fault;
  int trials = 200;
  std::uint32_t seed = 1;  ///< of the faults; trial i filters with seed + i
  std::optional<std::filesystem::path> json;
  /// Called after each trial, from any thread; may be empty.
  std::function<void()> progress = {};
};

/// \brief When something came to be, since another moment.
struct Delay {
  double seconds = 0;
  double metres = 0;  ///< along the true path
};

/// \brief One trial. Delays of `degraded` and `lost` count from the fault's beginning, the others
/// from its end; none: it never was so.
struct FaultTrial {
  std::size_t scan = 0;                 ///< of the drive, the first of the trial
  double jump = 0;                      ///< kidnapped by, m
  bool okBefore = false;                ///< in the scan before the fault
  std::optional<Delay> degraded, lost;  ///< first `degraded` or `lost`; first `lost`
  std::string lostReason;               ///< then; empty if never
  std::optional<Delay> right;           ///< the pose is right, and stays so over the next 5 m
  std::optional<Delay> ok;              ///< `ok`, with the right pose
  double okWrongMetres = 0;  ///< driven since the beginning, `ok` being said of a wrong pose
  double errorAfter = 0;     ///< mean over the 20 m after `ok`, m
  double errorMax = 0;       ///< greatest in the fault and after it, m
  bool passed = false;       ///< see passes()
};

/// \brief What is demanded: kidnap, wrongMap: `lost` within 5 s or 20 m (wrongMap: 20 m). Blind,
/// stuck, slip: at least `degraded` within 5 s, `ok` with the right pose within 20 m of the end.
bool passes(Fault fault, const FaultTrial& trial);

/// \brief A drive without fault, from the first `ok` on.
struct HealthyRun {
  double seconds = 0, metres = 0;
  std::size_t scans = 0, ok = 0, degraded = 0, lost = 0;
  std::size_t lostTimes = 0, degradedTimes = 0;  ///< in a row counts once
  double longestSeconds = 0;                     ///< not `ok` in a row
  std::map<std::string, std::size_t> reasons;    ///< scans by reason, those not `ok`
  double errorSum = 0, errorMax = 0;             ///< m, over all scans
  std::size_t wrongOk = 0;                       ///< `ok` with a wrong pose
  std::size_t relocalized = 0;
  std::size_t lostBefore = 0;  ///< scans called lost before the first `ok`
};

/// \brief Runs the trials in parallel; the same figures on any number of threads.
/// \throws Error as injectFault(), when wrongMap has no other map, or the fault is `none`.
std::vector<FaultTrial> runFaultTrials(const TrialDrive& drive, const FaultTrialsOptions& options);
/// \brief Drives the whole drive `trials` times. \throws Error when one never becomes `ok`.
std::vector<HealthyRun> runHealthy(const TrialDrive& drive, const FaultTrialsOptions& options);

/// \brief Everything, the JSON file if one is wanted; returns the table.
std::string evalFaults(const FaultTrialsOptions& options);

}  // namespace polemcl::apps
