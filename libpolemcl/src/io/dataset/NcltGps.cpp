#include "io/dataset/NcltGps.h"

#include <cmath>

#include "core/common/Angles.h"
#include "io/dataset/ScanFixes.h"

namespace polemcl::io {

void addNcltFixes(const std::filesystem::path& file, const ReadProgress& progress,
                  ScanFolder& folder) {
  NumberRowReader rows(file, 8,
                       "utime, mode, satellites, latitude, longitude, altitude, track, speed",
                       Separator::commas, progress);
  std::vector<double> row;
  while (rows.next(row)) {
    if (row[1] != 2 && row[1] != 3) continue;
    GnssFix fix;
    fix.time = row[0] * 1e-6;
    fix.latitude = row[3] / degree;
    fix.longitude = row[4] / degree;
    fix.sigma = kAssumedFixSigma;
    takeFix(fix, folder);
  }
  finishFixes(file.filename().string(), folder);
}

}  // namespace polemcl::io
