#include "core/sensor/AzimuthResolution.h"

#include <algorithm>
#include <cmath>

#include "core/common/Angles.h"
#include "core/sensor/ElevationHistogram.h"

namespace polemcl {
namespace {

constexpr double kStepCell = 0.005 * degree;
constexpr std::size_t kStepCells = 1000;      // steps up to 5°
constexpr double kLeastStep = 0.03 * degree;  // nearer returns are echoes of one pulse
constexpr double kLeastRho = 3;               // m
constexpr std::size_t kFewestSteps = 200;     // steps to tell from

/// Azimuths of one scan per beam, ascending.
std::vector<std::vector<double>> azimuthsByBeam(const PointsView& scan,
                                                const BeamTableEstimate& beams) {
  // Beams of both blocks as slopes from the origin of the first; near enough to tell them apart far
  // away.
  std::vector<std::vector<double>> rows(static_cast<std::size_t>(beams.beams()));
  for (std::size_t i = 0; i < scan.size; ++i) {
    const BeamPoint point{scan.x[i], scan.y[i], scan.z[i]};
    BeamCoordinates at = beamCoordinates(point, beams.origin);
    if (!std::isfinite(at.rho) || !std::isfinite(at.z) || at.rho < kLeastRho) continue;
    std::size_t first = 0, best = 0;
    double least = 1;
    for (const BeamBlock& block : beams.blocks) {
      const double e = std::atan2(point.z - block.apex, at.rho);
      const auto& list = block.elevations;  // descending
      const auto below = std::lower_bound(list.begin(), list.end(), e, std::greater<double>());
      for (const int k : {-1, 0}) {
        const auto index = below - list.begin() + k;
        if (index < 0 || index >= static_cast<std::ptrdiff_t>(list.size())) continue;
        const double off = std::abs(list[static_cast<std::size_t>(index)] - e);
        if (off >= least) continue;
        least = off;
        best = first + static_cast<std::size_t>(index);
      }
      first += list.size();
    }
    if (least > 3 * beams.spread + 0.02 * degree) continue;
    rows[best].push_back(std::atan2(point.y - beams.origin.y, point.x - beams.origin.x));
  }
  for (auto& row : rows) std::sort(row.begin(), row.end());
  return rows;
}

}  // namespace

int azimuthResolution(const std::vector<PointsView>& scans, const BeamTableEstimate& beams) {
  std::vector<double> steps;
  for (const PointsView& scan : scans)
    for (const auto& row : azimuthsByBeam(scan, beams))
      for (std::size_t i = 1; i < row.size(); ++i) {
        const double step = row[i] - row[i - 1];
        if (step > kLeastStep && step < (kStepCells - 2) * kStepCell) steps.push_back(step);
      }
  if (steps.size() < kFewestSteps) return 0;
  std::vector<double> counts(kStepCells, 0);
  for (const double step : steps) ++counts[static_cast<std::size_t>(step / kStepCell)];
  std::size_t mode = 2;
  const auto around = [&](std::size_t i) {
    return counts[i - 2] + 2 * counts[i - 1] + 3 * counts[i] + 2 * counts[i + 1] + counts[i + 2];
  };
  for (std::size_t i = 2; i + 2 < kStepCells; ++i)
    if (around(i) > around(mode)) mode = i;
  // All steps near the mode, in ascending order: their mean is that of the turn.
  const double middle = (static_cast<double>(mode) + 0.5) * kStepCell;
  std::sort(steps.begin(), steps.end());
  double sum = 0, count = 0;
  for (const double step : steps)
    if (std::abs(step - middle) < 0.6 * middle) {  // encoders may count half steps (HDL-64E)
      sum += step;
      ++count;
    }
  return static_cast<int>(std::lround(2 * M_PI * count / sum));
}

}  // namespace polemcl
