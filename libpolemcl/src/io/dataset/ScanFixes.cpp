#include "io/dataset/ScanFixes.h"

#include <algorithm>
#include <cmath>

namespace polemcl::io {

void takeFix(const GnssFix& fix, ScanFolder& folder) {
  if (isOnGlobe(fix) && std::isfinite(fix.time)) folder.fixes.push_back(fix);
}

void finishFixes(const std::string& source, ScanFolder& folder) {
  std::stable_sort(folder.fixes.begin(), folder.fixes.end(),
                   [](const GnssFix& a, const GnssFix& b) { return a.time < b.time; });
  folder.notes.push_back(source + ": " + std::to_string(folder.fixes.size()) +
                         " positions from satellites");
}

}  // namespace polemcl::io
