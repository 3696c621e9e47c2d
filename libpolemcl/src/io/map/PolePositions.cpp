#include "io/map/PolePositions.h"

#include <algorithm>
#include <cmath>

#include "core/common/Transform.h"
#include "io/file/AtomicFile.h"
#include "io/file/CsvTable.h"
#include "io/file/Date.h"
#include "io/file/Npz.h"
#include "io/file/TextFile.h"
#include "io/map/PoleMapFile.h"

namespace polemcl::io {

namespace {

using Positions = std::vector<Eigen::Vector2d>;

Positions readCsv(const std::filesystem::path& file) {
  const CsvTable table(file);
  const std::size_t x = table.column("x"), y = table.column("y");
  Positions positions;
  for (std::size_t row = 0; row < table.rows(); ++row)
    positions.emplace_back(table.number(row, x), table.number(row, y));
  return positions;
}

Positions readNpz(const std::filesystem::path& file) {
  const NpzFile npz(file);
  std::string name;
  for (const char* known : {"polemeans", "poleparams"}) {
    if (npz.contains(known)) name = known;
  }
  if (name.empty()) {
    const std::string found = joined(npz.names());
    throw Error(file.string() + ": no array poleparams or polemeans in it (found: " +
                (found.empty() ? "none" : found) + ")");
  }
  const NumberArray array = npz.array(name);
  if (array.shape.size() != 2 || array.shape[1] < 2) {
    std::string shape;
    for (const std::size_t size : array.shape)
      shape += (shape.empty() ? "" : "x") + std::to_string(size);
    throw Error(file.string() + ": array " + name + " of shape (" + shape +
                "); one row per pole with x and y first expected");
  }
  Positions positions;
  for (std::size_t row = 0; row < array.shape[0]; ++row) {
    const double* values = array.values.data() + row * array.shape[1];
    if (!std::isfinite(values[0]) || !std::isfinite(values[1])) {
      throw Error(file.string() + ": array " + name + ", row " + std::to_string(row) +
                  " (counted from 0) is not finite");
    }
    positions.emplace_back(values[0], values[1]);
  }
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

std::vector<Eigen::Vector2d> readPolePositions(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (ending == ".csv") return readCsv(file);
  if (ending == ".npz") return readNpz(file);
  if (ending == ".polemap") return centresOf(readPoleMap(file).poles);
  throw Error(file.string() + ": unknown kind of file '" + ending +
              "'; allowed: .polemap, .csv (columns x, y), .npz (poleparams or polemeans)");
}

}  // namespace polemcl::io
