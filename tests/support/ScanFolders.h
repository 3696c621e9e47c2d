#pragma once
// Tiny datasets for the tests of the programs.

#include <array>
#include <cmath>
#include <cstdio>

#include "support/TempFolder.h"

namespace testing_apps {

using Points = std::vector<std::array<float, 4>>;  ///< x y z intensity, sensor frame, m

inline std::string scanName(std::size_t i) {
  char name[32];
  std::snprintf(name, sizeof name, "%06zu.bin", i);
  return name;
}

inline void writeBin(const fs::path& file, const Points& points) {
  writeText(file, std::string(reinterpret_cast<const char*>(points.data()), points.size() * 16));
}

/// A row of poses.txt: x, y and yaw at height 0.
inline std::string poseRow(double x, double y, double yaw) {
  char row[256];
  const double c = std::cos(yaw), s = std::sin(yaw);
  std::snprintf(row, sizeof row, "%.17g %.17g 0 %.17g %.17g %.17g 0 %.17g 0 0 1 0\n", c, -s, x, s,
                c, y);
  return row;
}

/// Scans of two points each, at (i, 0) looking along x, 0.1 s apart, starting at 100 s.
inline void writeLine(const fs::path& folder, std::size_t scans, bool poses = true) {
  std::string times, rows;
  for (std::size_t i = 0; i < scans; ++i) {
    const auto x = static_cast<float>(i);
    writeBin(folder / "velodyne" / scanName(i), {{x + 1, 2, 3, 0.5f}, {-4, x, 1, 0.25f}});
    times += std::to_string(100 + 0.1 * static_cast<double>(i)) + '\n';
    rows += poseRow(static_cast<double>(i), 0, 0);
  }
  writeText(folder / "times.txt", times);
  if (poses) writeText(folder / "poses.txt", rows);
}

/// Arguments of pole-import, from `in` to `out.rawlog`.
inline std::vector<std::string> importArguments(const TempFolder& folder,
                                                const std::string& dataset,
                                                std::vector<std::string> more) {
  more.insert(more.begin(), {dataset, "--input", (folder / "in").string(), "--output",
                             (folder / "out.rawlog").string()});
  return more;
}

}  // namespace testing_apps
