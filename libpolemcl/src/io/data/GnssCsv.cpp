#include "io/data/GnssCsv.h"

#include <cmath>

#include <polemcl/core/common/Types.h>
#include "io/file/CsvTable.h"

namespace polemcl::io {
namespace {

/// \throws Error when a column is beyond its limit.
void require(bool right, const CsvTable& table, std::size_t row, const char* what) {
  if (!right) throw Error(table.at(row) + what);
}

}  // namespace

std::vector<GnssFix> readGnssCsv(const std::filesystem::path& file) {
  const CsvTable table(file);
  const std::size_t time = table.column("time"), latitude = table.column("latitude"),
                    longitude = table.column("longitude"), sigma = table.column("sigma");
  const auto x = table.find("antenna_x"), y = table.find("antenna_y");
  std::vector<GnssFix> fixes;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    GnssFix fix;
    fix.time = table.number(row, time);
    fix.latitude = table.number(row, latitude);
    fix.longitude = table.number(row, longitude);
    fix.sigma = table.number(row, sigma);
    if (x) fix.antenna_robot.x() = table.number(row, *x);
    if (y) fix.antenna_robot.y() = table.number(row, *y);
    require(isOnGlobe(fix), table, row,
            "latitude must be within -90 and 90 deg, longitude within -180 and 180");
    require(fix.sigma > 0, table, row, "sigma must be above 0 m");
    require(fixes.empty() || fix.time >= fixes.back().time, table, row,
            "time goes back; fixes must come in order");
    fixes.push_back(fix);
  }
  return fixes;
}

}  // namespace polemcl::io
