#pragma once
/// \file ExtractionEval.h
/// \brief `pole-eval detections`, `repeatability` and `rotation`: how good an extractor is.

#include <filesystem>
#include <optional>

#include "cli/Settings.h"
#include "core/evaluation/DetectionEvaluation.h"
#include "core/evaluation/Repeatability.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl::apps {

/// \brief `pole-eval detections`.
struct EvalDetectionsOptions {
  std::filesystem::path scans;  ///< simulated folder: scans, labels, poses, poles_gt.csv
  std::filesystem::path poles;  ///< rawlog of poles of these scans, or of some of them
  double radius = 0.5;          ///< of matching, m
  std::optional<std::filesystem::path> json;
  /// Table of the true poles that the scans show: `id,x,y,radius,top,scans`, the last being the
  /// number of scans each is visible in.
  std::optional<std::filesystem::path> visible;
  std::size_t minScans = 1;  ///< poles visible in fewer scans are not in that table
};
/// \brief Compares the poles of each scan with the true ones (core/DetectionEvaluation.h), visible
/// as core/PoleVisibility.h says. Scans and poles belong together by their times.
/// \throws Error naming the file: no labels, poses or true poles, a scan of the rawlog that is not
///         in the folder, a rawlog of scans instead of poles.
DetectionScore evalDetections(const EvalDetectionsOptions& options);

/// \brief `pole-eval repeatability`.
struct EvalRepeatabilityOptions {
  std::filesystem::path poles;  ///< rawlog of poles
  std::filesystem::path truth;  ///< TUM, robot poses
  std::optional<std::filesystem::path> json;
};
/// \brief Poles found again in the next scans, moved by the (planar) true poses.
/// \throws Error naming the file: a scan at a time without a true pose, too few scans.
RepeatabilityScore evalRepeatability(const EvalRepeatabilityOptions& options);

/// \brief `pole-eval rotation`.
struct EvalRotationOptions {
  std::filesystem::path input;  ///< rawlog of scans
  std::size_t every = 1;        ///< N: scans 0, N, 2N, … are turned; at least 1
  double radius = 0.01;         ///< of matching, m
  std::optional<std::filesystem::path> json;
  ScanProgress progress = {};  ///< may be empty
};
/// \brief Poles found again when a scan is turned about the vertical.
/// \throws Error naming the file: a rawlog of poles instead of scans.
RotationScore evalRotation(const EvalRotationOptions& options, const AllSettings& settings);

}  // namespace polemcl::apps
