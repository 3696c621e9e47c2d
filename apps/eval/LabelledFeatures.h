#pragma once
/// \file LabelledFeatures.h
/// \brief `pole-eval features`: the candidates of a drive with what the classifier looks at, and
/// labels.

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>

#include "cli/Settings.h"

namespace polemcl::apps {

/// \brief `pole-eval features`.
struct FeaturesOptions {
  /// Folder with `velodyne/*.bin` or `*.pcd`, and `poses.txt`. Clouds are in the LiDAR's own frame.
  std::filesystem::path scans;
  Eigen::Isometry3d T_robot_sensor = Eigen::Isometry3d::Identity();
  /// True poles: columns id, x, y, radius, top. Without: labels by all scans together
  /// (core/evaluation/MultiScanLabels.h).
  std::optional<std::filesystem::path> poles;
  std::filesystem::path output;  ///< table to write (CSV)
};

struct FeaturesSummary {
  std::size_t scans = 0, poles = 0, others = 0, unsure = 0;  ///< unsure: not written
};

/// \brief Extracts the candidates of each scan, labels them and writes the table.
///
/// Columns: scan, x, y (map frame, m), pole (1 or 0), squared_error (of the centre, divided by the
/// covariance of the fit; empty when the true centre is not known), odds (by the weights in use),
/// the terms of the classifier, and with the prefix `covariance_` those of the covariance.
/// share/experiments/fit_classifier.py reads it.
/// \throws Error naming the file: no poses, unreadable scans or poles; a sensor that hangs or has
///         an origin of its own.
FeaturesSummary writeFeatures(const FeaturesOptions& options, const AllSettings& settings);

}  // namespace polemcl::apps
