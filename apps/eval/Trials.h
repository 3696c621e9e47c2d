#pragma once
/// \file Trials.h
/// \brief The trials of `pole-eval`: `global`, `starts` and `faults`. Each row of one table says
/// how a trial is made from a drive and what is told of the outcomes; all else is the same.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "eval/FaultInjection.h"
#include "eval/Figures.h"

namespace polemcl::apps {

struct TrialOptions : EvalOptions {
  TrialDriveFiles files;
  int trials = 200;
  std::uint32_t seed = 1;  ///< of the places; trial i filters with seed + i
  double metres = 60;      ///< of global and starts: driven in each trial, at most
  FaultOptions fault;
  std::optional<std::filesystem::path> otherMap;  ///< of Fault::wrongMap
  /// Called after each trial, from any thread; may be empty.
  std::function<void()> progress = {};
};

/// \brief Makes trial i of a command; may be called from several threads.
using TrialMaker = std::function<Trial(std::uint32_t index)>;

/// \name Makers
/// The first two start at scans drawn uniformly among those after which `metres` are still driven.
/// \throws Error when the drive is shorter than `metres`.
/// @{
TrialMaker startsAnywhere(const TrialDrive& drive, const TrialOptions& options);
/// \brief The pose given is drawn as `[start]` draws particles: uniformly in the disc and the
/// headings around the true pose.
TrialMaker startsNearby(const TrialDrive& drive, const TrialOptions& options);
TrialMaker faultyStretches(const TrialDrive& drive, const TrialOptions& options);
/// @}

/// \brief Runs the trials in parallel; the same outcomes, but times, on any number of threads.
/// \throws Error as the maker and Localizer.
std::vector<TrialOutcome> runTrials(const TrialDrive& drive, const TrialOptions& options,
                                    const TrialMaker& maker);

/// \name What is told of the outcomes
/// @{
Figures globalFigures(const TrialDrive& drive, const TrialOptions& options,
                      const std::vector<TrialOutcome>& outcomes);
Figures startFigures(const TrialDrive& drive, const TrialOptions& options,
                     const std::vector<TrialOutcome>& outcomes);
/// \throws Error when a drive without fault never becomes `ok`.
Figures faultFigures(const TrialDrive& drive, const TrialOptions& options,
                     const std::vector<TrialOutcome>& outcomes);
/// @}

/// \brief What is demanded: kidnap, wrongMap: `lost` within 5 s or 20 m (wrongMap: 20 m). Blind,
/// stuck, slip: at least `degraded` within 5 s (jump: 0.5 s), `ok` with the right pose within 20 m
/// of the end.
bool passes(Fault fault, const TrialOutcome& outcome);

}  // namespace polemcl::apps
