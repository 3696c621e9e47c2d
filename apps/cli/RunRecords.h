#pragma once
/// \file RunRecords.h
/// \brief Files of a run of `pole-localize`: estimates with covariances, and the health.

#include <filesystem>
#include <string>
#include <vector>

#include "core/common/PoseEstimate.h"

namespace polemcl::apps {

/// \brief A row of `run_NN_cov.csv`.
struct EstimateRecord {
  double scan = 0;  ///< number of the scan in the rawlog, from 0
  double time = 0;  ///< s
  PoseWithCovariance estimate;
};

/// \brief The head of such a table, and one row of it, each with its line end.
extern const char* const kEstimateColumns;
std::string estimateRow(std::size_t scan, double time, const PoseWithCovariance& estimate);

/// \throws Error as CsvTable.
std::vector<EstimateRecord> readEstimates(const std::filesystem::path& file);

/// \brief The states of `run_NN_health.csv`.
class HealthRecords {
 public:
  /// \throws Error as CsvTable, and unless there is one row for each scan.
  explicit HealthRecords(const std::filesystem::path& file);
  /// \brief Whether a scan is `ok`. \throws Error when the file has no such scan.
  bool isOk(double scan) const;

 private:
  std::filesystem::path m_file;
  std::vector<bool> m_ok;
};

}  // namespace polemcl::apps
