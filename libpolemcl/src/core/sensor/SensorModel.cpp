#include "core/sensor/SensorModel.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/common/Angles.h"
#include "core/common/Binder.h"
#include "core/sensor/PinholeCamera.h"

namespace polemcl {
namespace {

/// Slopes are looked up in cells this small: a tenth of the narrowest beam spacing in use (0.3°).
constexpr double kCellSlope = 0.0005;

struct Preset {
  const char* name;
  int columns;
  std::vector<double> elevationsDeg;  ///< upper block, or all
  double offset = 0;                  ///< m
  std::vector<double> lowerDeg = {};  ///< lower block of a two-block sensor
  double lowerOffset = 0;
};

std::vector<double> fan(int beams, double topDeg, double bottomDeg) {
  std::vector<double> elevations(beams);
  for (int i = 0; i < beams; ++i)
    elevations[i] = topDeg + (bottomDeg - topDeg) * i / std::max(1, beams - 1);
  return elevations;
}

/// Beams of the HDL-64E of KITTI, fitted per laser on raw scans (z against rho, residual 0.3 mm).
const std::vector<double> kHdl64Upper = {
    1.937,  1.574,  1.305,  0.872,  0.579,  0.181,  -0.089, -0.452, -0.803, -1.201, -1.494,
    -1.833, -2.208, -2.547, -2.874, -3.236, -3.539, -3.936, -4.215, -4.588, -4.914, -5.251,
    -5.611, -5.958, -6.329, -6.676, -6.999, -7.287, -7.679, -8.058, -8.310, -8.711};
const std::vector<double> kHdl64Lower = {
    -9.026,  -9.574,  -10.063, -10.471, -10.957, -11.599, -12.115, -12.562,
    -13.041, -13.485, -14.048, -14.598, -15.189, -15.657, -16.177, -16.554,
    -17.187, -17.730, -18.324, -18.797, -19.320, -19.736, -20.222, -20.787,
    -21.316, -21.935, -22.437, -22.857, -23.323, -23.971, -24.507, -24.999};

/// Beams of an OS1-64 (second generation, "45°"), measured on real scans.
const std::vector<double> kOs1Gen2 = {
    21.23,  20.61,  19.99,  19.37,  18.73,  18.11,  17.45,  16.77,  16.11,  15.47,  14.79,
    14.13,  13.45,  12.79,  12.11,  11.41,  10.75,  10.07,  9.37,   8.69,   7.99,   7.28,
    6.57,   5.87,   5.19,   4.47,   3.77,   3.07,   2.35,   1.67,   0.93,   0.23,   -0.47,
    -1.19,  -1.87,  -2.57,  -3.29,  -3.99,  -4.71,  -5.39,  -6.09,  -6.79,  -7.45,  -8.17,
    -8.87,  -9.55,  -10.23, -10.89, -11.59, -12.23, -12.89, -13.57, -14.23, -14.87, -15.53,
    -16.19, -16.83, -17.45, -18.09, -18.69, -19.35, -19.93, -20.57, -21.17};

const std::vector<Preset>& presets() {
  static const std::vector<Preset> all = {
      {"hdl64e", 2083, kHdl64Upper, 0.2035, kHdl64Lower, 0.1210},
      {"hdl32e", 2170, fan(32, 10.667, -30.667)},  // data sheet: steps of 1.333°
      {"vlp16", 1800, fan(16, 15, -15)},           // data sheet
      {"os1_64", 1024, fan(64, 16.611, -16.611)},  // data sheet, first generation
      {"os1_64_gen2", 1024, kOs1Gen2},
      {"os1_128", 1024, fan(128, 22.5, -22.5)},  // data sheet
      {"os0_64", 1024, fan(64, 45, -45)},        // data sheet
  };
  return all;
}

}  // namespace

std::vector<std::string> SensorModel::modelNames() {
  std::vector<std::string> names;
  for (const auto& preset : presets()) names.emplace_back(preset.name);
  names.insert(names.end(), {"uniform", "table"});
  return names;
}

SensorModel::SensorModel(const SensorOptions& options) {
  checkOptions(options);
  std::vector<double> upper, lower;
  double offset = 0, lowerOffset = 0;
  int columns = 0;
  const auto preset = std::find_if(presets().begin(), presets().end(),
                                   [&](const Preset& p) { return p.name == options.model; });
  if (preset != presets().end()) {
    columns = preset->columns;
    for (double e : preset->elevationsDeg) upper.push_back(e * degree);
    for (double e : preset->lowerDeg) lower.push_back(e * degree);
    offset = preset->offset;
    lowerOffset = preset->lowerOffset;
  } else if (options.model == "table") {
    upper = options.elevations;
    lower = options.lowerElevations;
    offset = options.upperApex;
    lowerOffset = options.lowerApex;
  } else {
    for (double e : fan(options.rings, options.fovUp, options.fovDown)) upper.push_back(e);
  }
  if (options.upsideDown) {
    for (double& e : upper) e = -e;
    for (double& e : lower) e = -e;
    upper.swap(lower.empty() ? upper : lower);
    std::swap(offset, lower.empty() ? offset : lowerOffset);
    offset = -offset;
    lowerOffset = -lowerOffset;
  }
  m_columns = options.columns > 0 ? options.columns : columns;
  m_columnAngle = 2 * M_PI / m_columns;

  std::sort(upper.rbegin(), upper.rend());
  std::sort(lower.rbegin(), lower.rend());
  for (double e : upper) m_beams.push_back({std::tan(e), offset});
  for (double e : lower) m_beams.push_back({std::tan(e), lowerOffset});
  for (int i = 0; i < beamCount(); ++i) {
    const int a = std::max(0, i - 1);
    const int b = std::min(beamCount() - 1, a + 1);
    m_spacingAbove.push_back(a == b ? 0.02
                                    : std::atan(m_beams[a].slope) - std::atan(m_beams[b].slope));
  }
  const int split = static_cast<int>(upper.size());
  m_lookup.cellsPerSlope = static_cast<float>(1 / kCellSlope);
  buildBlock(0, 0, split - 1);
  if (lower.empty()) return;
  buildBlock(1, split, beamCount() - 1);
  m_lookup.splitSlope = static_cast<float>((m_beams[split - 1].slope + m_beams[split].slope) / 2);
  m_lookup.splitOffset =
      static_cast<float>((m_beams[split - 1].offset + m_beams[split].offset) / 2);
}

SensorModel::SensorModel(const PinholeCamera& camera) {
  camera.validate();
  const Eigen::Vector3d ahead = camera.R_lidar_camera.col(0);
  // Poles cross those lines of pixels that lie more level: the columns of a camera on its side.
  const bool onSide = std::abs(camera.R_lidar_camera(2, 1)) > std::abs(camera.R_lidar_camera(2, 2));
  Eigen::Vector3d up = camera.R_lidar_camera.col(onSide ? 1 : 2);
  const int lines = onSide ? camera.width : camera.height;
  const double focal = onSide ? camera.fx : camera.fy;
  const double focalAcross = onSide ? camera.fy : camera.fx;
  double centre = onSide ? camera.cx : camera.cy;
  if (up.z() < 0) {
    up = -up;
    centre = lines - 1 - centre;
  }
  for (int row = 0; row < lines; ++row) m_beams.push_back({(centre - row) / focal, 0});
  for (int row = 0; row < lines; ++row) {
    const int above = std::max(0, row - 1);
    m_spacingAbove.push_back(std::atan(m_beams[above].slope) - std::atan(m_beams[above + 1].slope));
  }
  // Looking down, the same pixels cover more of a turn.
  const double level = std::max(0.1, ahead.head<2>().norm());
  m_columnAngle = std::atan(1 / (focalAcross * level));
  m_columns = static_cast<int>(std::ceil(2 * M_PI / m_columnAngle));
  m_lookup.planes = true;
  m_lookup.cells[0] = static_cast<float>(lines);
  m_lookup.cellsPerSlope = static_cast<float>(focal);
  m_lookup.minSlope[0] = static_cast<float>((centre - (lines - 0.5)) / focal);
  for (int k = 0; k < 3; ++k) {
    m_lookup.ahead[k] = static_cast<float>(ahead[k]);
    m_lookup.up[k] = static_cast<float>(up[k]);
  }
}

float SensorModel::heightOver(int row, float x, float y, float rho) const {
  const float slope = static_cast<float>(m_beams[row].slope);
  if (!m_lookup.planes) return rho * slope + static_cast<float>(m_beams[row].offset);
  // Where the plane (up - slope * ahead) · p = 0 meets the vertical line over the place.
  const float* ahead = m_lookup.ahead;
  const float* up = m_lookup.up;
  const float steep = up[2] - slope * ahead[2];
  if (steep < 1e-3f) return std::numeric_limits<float>::infinity();
  return ((slope * ahead[0] - up[0]) * x + (slope * ahead[1] - up[1]) * y) / steep;
}

void SensorModel::buildBlock(int block, int firstRow, int lastRow) {
  // The outermost beams accept as much beyond themselves as half their gap to the next, 0.3° at
  // least.
  const double topGap = m_beams[firstRow].slope - m_beams[firstRow + 1].slope;
  const double bottomGap = m_beams[lastRow - 1].slope - m_beams[lastRow].slope;
  const double top = m_beams[firstRow].slope + std::max(0.5 * topGap, 0.005);
  const double bottom = m_beams[lastRow].slope - std::max(0.5 * bottomGap, 0.005);
  const int cells = static_cast<int>(std::ceil((top - bottom) / kCellSlope));
  m_lookup.offset[block] = static_cast<float>(m_beams[firstRow].offset);
  m_lookup.minSlope[block] = static_cast<float>(bottom);
  m_lookup.cells[block] = static_cast<float>(cells);
  m_lookup.base[block] = static_cast<std::int32_t>(m_lookup.row.size());
  int row = lastRow;
  for (int i = 0; i < cells; ++i) {
    const double slope = bottom + (i + 0.5) * kCellSlope;
    while (row > firstRow &&
           std::abs(m_beams[row - 1].slope - slope) <= std::abs(m_beams[row].slope - slope))
      --row;
    m_lookup.row.push_back(row);
  }
}

}  // namespace polemcl
