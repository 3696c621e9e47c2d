#pragma once
/// \file TrainingCandidates.h
/// \brief `pole-eval candidates`: the labelled candidates of a drive, for `pole-eval train`.

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>

#include "cli/Settings.h"
#include "core/extraction/PoleClassifier.h"

namespace polemcl::apps {

/// \brief `pole-eval candidates`.
struct CandidatesOptions {
  /// Folder with `velodyne/*.bin` or `*.pcd`, and `poses.txt`. Clouds are in the LiDAR's own frame.
  std::filesystem::path scans;
  Eigen::Isometry3d T_robot_sensor = Eigen::Isometry3d::Identity();
  /// True poles: columns id, x, y, radius, top. Without: labels by multi-scan consistency
  /// (core/evaluation/MultiScanLabels.h).
  std::optional<std::filesystem::path> poles;
  std::size_t every = 1;         ///< take scans 0, N, 2N, …
  std::filesystem::path output;  ///< table to write (CSV)
};

struct CandidatesSummary {
  std::size_t scans = 0, poles = 0, others = 0, unsure = 0;  ///< unsure: not written
};

/// \brief One labelled candidate: a row of the table.
struct LabelledCandidate {
  PoleFeatures features;
  double columnAngle = 0;  ///< one firing step, rad
  bool pole = false;
  /// Squared error of its centre, divided by the covariance of the fit; nothing when the true
  /// centre is not known.
  std::optional<double> squaredError;
};

/// \brief Candidates of one drive.
struct LabelledDrive {
  std::string name;    ///< of the file, without its extension
  std::string sensor;  ///< model
  bool real = false;   ///< labelled by consistency
  std::vector<LabelledCandidate> candidates;
};

/// \brief Extracts the candidates of each scan, labels them and writes the table.
/// \throws Error naming the file: no poses, unreadable scans or poles; a sensor that hangs or has
///         an origin of its own.
CandidatesSummary writeCandidates(const CandidatesOptions& options, const AllSettings& settings);

/// \brief Reads a table of writeCandidates(). \throws Error with file and line.
LabelledDrive readCandidates(const std::filesystem::path& file);

}  // namespace polemcl::apps
