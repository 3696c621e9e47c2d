#include "cli/RunRecords.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "io/file/CsvTable.h"

namespace polemcl::apps {

const char* const kEstimateColumns = "scan,timestamp,x_m,y_m,yaw_rad,xx,xy,xyaw,yy,yyaw,yawyaw\n";

std::string estimateRow(std::size_t scan, double time, const PoseWithCovariance& estimate) {
  const auto& [mean, C] = estimate;
  char line[300];
  std::snprintf(line, sizeof line, "%zu,%.9f,%.6f,%.6f,%.9f,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", scan,
                time, mean.x, mean.y, mean.yaw, C(0, 0), C(0, 1), C(0, 2), C(1, 1), C(1, 2),
                C(2, 2));
  return line;
}

std::vector<EstimateRecord> readEstimates(const std::filesystem::path& file) {
  const io::CsvTable table(file);
  const char* names[] = {"scan", "timestamp", "x_m", "y_m",  "yaw_rad", "xx",
                         "xy",   "xyaw",      "yy",  "yyaw", "yawyaw"};
  std::vector<std::size_t> columns;
  columns.reserve(std::size(names));
  for (const char* name : names) columns.push_back(table.column(name));
  std::vector<EstimateRecord> rows;
  rows.reserve(table.rows());
  for (std::size_t i = 0; i < table.rows(); ++i) {
    // All numbers first: a matrix that an exception leaves half filled ends a debug build.
    std::array<double, std::size(names)> v;
    for (std::size_t k = 0; k < v.size(); ++k) v[k] = table.number(i, columns[k]);
    EstimateRecord row;
    row.scan = v[0];
    row.time = v[1];
    row.estimate.mean = {v[2], v[3], v[4]};
    row.estimate.covariance << v[5], v[6], v[7], v[6], v[8], v[9], v[7], v[9], v[10];
    rows.push_back(row);
  }
  return rows;
}

HealthRecords::HealthRecords(const std::filesystem::path& file) : m_file(file) {
  const io::CsvTable table(file);
  const std::size_t scan = table.column("scan"), state = table.column("state");
  for (std::size_t i = 0; i < table.rows(); ++i) {
    if (table.number(i, scan) != static_cast<double>(i))
      throw Error(table.at(i) + "scan " + std::to_string(i) + " expected: one row for each scan");
    m_ok.push_back(table.text(i, state) == "ok");
  }
}

bool HealthRecords::isOk(double scan) const {
  if (scan < 0 || scan >= static_cast<double>(m_ok.size()))
    throw Error(m_file.string() + ": no scan " + std::to_string(std::llround(scan)) +
                "; does it belong to the same run as the covariances?");
  return m_ok[static_cast<std::size_t>(scan)];
}

}  // namespace polemcl::apps
