#include "io/map/PoleTables.h"

#include <cmath>

#include "io/file/CsvTable.h"
#include "io/file/Date.h"
#include "io/file/Npz.h"
#include "io/map/PolePositions.h"

namespace polemcl::io {
namespace {

MapPole poleAt(double x, double y) {
  MapPole pole;
  pole.x = x;
  pole.y = y;
  pole.radius = 0.1;
  pole.count = 1;
  return pole;
}

/// Optional columns of one row.
class Row {
 public:
  Row(const CsvTable& table, std::size_t row) : m_table(table), m_row(row) {}
  void take(const char* name, double& value) const {
    if (const auto column = m_table.find(name)) value = m_table.number(m_row, *column);
  }
  void take(const char* name, std::uint32_t& value) const {
    if (const auto column = m_table.find(name)) value = m_table.count(m_row, *column);
  }
  void takeDay(const char* name, double& time) const {
    const auto column = m_table.find(name);
    if (!column || m_table.text(m_row, *column).empty()) return;
    try {
      time = secondsOfDate(m_table.text(m_row, *column));
    } catch (const Error& error) {
      throw Error(m_table.at(m_row) + error.what());
    }
  }

 private:
  const CsvTable& m_table;
  std::size_t m_row;
};

MapPole readPole(const CsvTable& table, std::size_t row) {
  MapPole pole = poleAt(table.number(row, table.column("x")), table.number(row, table.column("y")));
  const Row fields(table, row);
  fields.take("radius", pole.radius);
  fields.take("count", pole.count);
  fields.take("bottom", pole.bottom);
  fields.take("top", pole.top);
  fields.take("confidence", pole.confidence);
  fields.take("cov_xx", pole.covariance(0, 0));
  fields.take("cov_xy", pole.covariance(0, 1));
  fields.take("cov_yy", pole.covariance(1, 1));
  pole.covariance(1, 0) = pole.covariance(0, 1);
  return pole;
}

PoleHistory readHistoryColumn(const CsvTable& table, std::size_t row) {
  PoleHistory history;
  const Row fields(table, row);
  fields.take("existence", history.existence);
  fields.take("seen", history.seen);
  fields.take("missed", history.missed);
  fields.takeDay("first_seen", history.firstSeen);
  fields.takeDay("last_seen", history.lastSeen);
  return history;
}

/// The radii of the poles, if the file has them.
std::vector<double> readRadii(const std::filesystem::path& file) {
  const NpzFile npz(file);
  if (npz.contains("poleparams") || !npz.contains("polemeans")) return {};
  const NumberArray array = npz.array("polemeans");
  std::vector<double> radii;
  if (array.shape.size() != 2 || array.shape[1] != 3) return radii;
  for (std::size_t row = 0; row < array.shape[0]; ++row) {
    radii.push_back(array.values[3 * row + 2]);
    if (!(radii.back() >= 0 && std::isfinite(radii.back())))
      throw Error(file.string() + ": array polemeans, row " + std::to_string(row) +
                  " (counted from 0): the third number is not a radius");
  }
  return radii;
}

}  // namespace

PoleMapData readPoleCsv(const std::filesystem::path& file) {
  const CsvTable table(file);
  PoleMapData map;
  table.column("x");  // missing columns are an error even without rows
  table.column("y");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    map.poles.push_back(readPole(table, row));
    if (table.find("existence")) map.histories.push_back(readHistoryColumn(table, row));
  }
  return map;
}

PoleMapData readPoleNpz(const std::filesystem::path& file) {
  PoleMapData map;
  const auto radii = readRadii(file);
  for (const Eigen::Vector2d& at : readPolePositions(file)) {
    MapPole pole = poleAt(at.x(), at.y());
    if (!radii.empty()) pole.radius = radii.at(map.poles.size());
    map.poles.push_back(pole);
  }
  return map;
}

}  // namespace polemcl::io
