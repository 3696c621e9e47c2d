#include "io/data/GnssCsv.h"

#include <cmath>
#include <string>

#include <polemcl/core/common/Types.h>
#include "io/file/CsvTable.h"
#include "io/file/TextFile.h"

namespace polemcl::io {

namespace {

/// \throws Error unless a fix that follows one of the time `before` may be like this.
void requireUsable(const GnssFix& fix, double before, const std::string& where) {
  if (std::abs(fix.latitude) > 90)
    throw Error(where + "latitude " + significant(fix.latitude, 9) +
                "; degrees from -90 to 90 are allowed");
  if (std::abs(fix.longitude) > 180)
    throw Error(where + "longitude " + significant(fix.longitude, 9) +
                "; degrees from -180 to 180 are allowed");
  if (!(fix.sigma > 0))
    throw Error(where + "sigma " + significant(fix.sigma, 9) + "; metres above 0 are allowed");
  if (fix.time < before)
    throw Error(where + "time " + fixed(fix.time, 3) + " is before that of the row above, " +
                fixed(before, 3) + "; sort the rows by time");
}

}  // namespace

std::vector<GnssFix> readGnssCsv(const std::filesystem::path& file) {
  const CsvTable table(file);
  const std::size_t time = table.column("time"), latitude = table.column("latitude"),
                    longitude = table.column("longitude"), sigma = table.column("sigma");
  std::vector<GnssFix> fixes;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    GnssFix fix;
    fix.time = table.number(row, time);
    fix.latitude = table.number(row, latitude);
    fix.longitude = table.number(row, longitude);
    fix.sigma = table.number(row, sigma);
    requireUsable(fix, fixes.empty() ? fix.time : fixes.back().time, table.at(row));
    fixes.push_back(fix);
  }
  return fixes;
}

}  // namespace polemcl::io
