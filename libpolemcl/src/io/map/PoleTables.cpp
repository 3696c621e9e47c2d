#include "io/map/PoleTables.h"

#include <algorithm>
#include <cmath>

#include "core/common/Transform.h"
#include "io/file/AtomicFile.h"
#include "io/file/CsvTable.h"
#include "io/file/Date.h"
#include "io/file/Npz.h"
#include "io/file/TextFile.h"

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

/// The array of the poles, one row per pole. \param name Set to that of the array.
NumberArray polesIn(const std::filesystem::path& file, std::string& name) {
  const NpzFile npz(file);
  for (const char* known : {"polemeans", "poleparams"}) {
    if (npz.contains(known)) name = known;
  }
  if (name.empty()) {
    const std::string found = joined(npz.names());
    throw Error(file.string() + ": no array poleparams or polemeans in it (found: " +
                (found.empty() ? "none" : found) + ")");
  }
  NumberArray array = npz.array(name);
  if (array.shape.size() != 2 || array.shape[1] < 2) {
    std::string shape;
    for (const std::size_t size : array.shape)
      shape += (shape.empty() ? "" : "x") + std::to_string(size);
    throw Error(file.string() + ": array " + name + " of shape (" + shape +
                "); one row per pole with x and y first expected");
  }
  return array;
}

/// \param withRadii Those of `polemeans` are read and checked as well.
std::vector<MapPole> readNpz(const std::filesystem::path& file, bool withRadii) {
  std::string name;
  const NumberArray array = polesIn(file, name);
  const bool hasRadii = withRadii && name == "polemeans" && array.shape[1] == 3;
  std::vector<MapPole> poles;
  for (std::size_t row = 0; row < array.shape[0]; ++row) {
    const double* values = array.values.data() + row * array.shape[1];
    const auto refuse = [&](const char* what) {
      throw Error(file.string() + ": array " + name + ", row " + std::to_string(row) +
                  " (counted from 0)" + what);
    };
    if (!std::isfinite(values[0]) || !std::isfinite(values[1])) refuse(" is not finite");
    poles.push_back(poleAt(values[0], values[1]));
    if (!hasRadii) continue;
    poles.back().radius = values[2];
    if (!(values[2] >= 0 && std::isfinite(values[2]))) refuse(": the third number is not a radius");
  }
  return poles;
}

std::vector<Eigen::Vector2d> readCsvPositions(const std::filesystem::path& file) {
  const CsvTable table(file);
  const std::size_t x = table.column("x"), y = table.column("y");
  std::vector<Eigen::Vector2d> positions;
  for (std::size_t row = 0; row < table.rows(); ++row)
    positions.emplace_back(table.number(row, x), table.number(row, y));
  return positions;
}

}  // namespace

void writePoleCsv(const std::filesystem::path& file, const std::vector<MapPole>& poles,
                  const std::vector<PoleHistory>& histories) {
  AtomicFile output(file);
  output.stream() << "x,y,radius,count,bottom,top,confidence,cov_xx,cov_xy,cov_yy"
                  << (histories.empty() ? "\n" : ",existence,seen,missed,first_seen,last_seen\n");
  for (std::size_t i = 0; i < poles.size(); ++i) {
    const MapPole& p = poles[i];
    output.stream() << fixed(p.x, 6) << ',' << fixed(p.y, 6) << ',' << fixed(p.radius, 6) << ','
                    << std::to_string(p.count);
    for (const double value : {p.bottom, p.top, p.confidence, p.covariance(0, 0),
                               p.covariance(0, 1), p.covariance(1, 1)}) {
      output.stream() << ',' << significant(value, 9);
    }
    if (!histories.empty()) {
      const PoleHistory& h = histories.at(i);
      output.stream() << ',' << significant(h.existence, 6) << ',' << std::to_string(h.seen) << ','
                      << std::to_string(h.missed) << ',' << dateText(h.firstSeen) << ','
                      << dateText(h.lastSeen);
    }
    output.stream() << '\n';
  }
  output.commit();
}

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
  map.poles = readNpz(file, true);
  return map;
}

std::vector<Eigen::Vector2d> readPolePositions(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (ending == ".csv") return readCsvPositions(file);
  if (ending == ".npz") return centresOf(readNpz(file, false));
  if (ending == ".polemap") return centresOf(readPoleMap(file).poles);
  throw Error(file.string() + ": unknown kind of file '" + ending +
              "'; allowed: .polemap, .csv (columns x, y), .npz (poleparams or polemeans)");
}

}  // namespace polemcl::io
