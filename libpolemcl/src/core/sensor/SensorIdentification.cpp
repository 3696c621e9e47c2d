#include "core/sensor/SensorIdentification.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/common/Angles.h"
#include "core/common/PointsCopy.h"
#include "core/common/Statistics.h"
#include "core/sensor/ElevationHistogram.h"
#include "core/sensor/SensorModel.h"

namespace polemcl {
namespace {

// Returns nearer than this and higher over the ground may be the vehicle's own. In clouds that were
// corrected for motion these are off their beams.
constexpr double kVehicleReach = 3;     ///< m, horizontal
constexpr double kVehicleBottom = 0.4;  ///< m
constexpr double kLeastRest = 0.5;      ///< else the near returns are the surroundings, as indoors

PointsCopy withoutVehicle(const PointsView& scan) {
  const auto ground = findGroundPlane(scan);
  PointsCopy rest;
  for (std::size_t i = 0; i < scan.size; ++i) {
    const Eigen::Vector3d point(scan.x[i], scan.y[i], scan.z[i]);
    if (ground && point.head<2>().norm() < kVehicleReach && !point.isZero(0) &&
        ground->heightOf(point) > kVehicleBottom)
      continue;
    rest.add(scan, i);
  }
  const auto all = static_cast<double>(scan.size);
  if (static_cast<double>(rest.x.size()) < kLeastRest * all)
    return {
        {scan.x, scan.x + scan.size}, {scan.y, scan.y + scan.size}, {scan.z, scan.z + scan.size}};
  return rest;
}

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

/// Firing steps in a full turn: the commonest step of azimuth between neighbours on a beam of these
/// scans. \return 0 when no step stands out.
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

/// A cloud on its head, turned about x.
BeamTableEstimate turnedOver(BeamTableEstimate beams) {
  beams.origin.y = -beams.origin.y;
  // Time runs the other way round.
  beams.origin.slide = -beams.origin.slide;
  for (BeamBlock& block : beams.blocks) {
    block.apex = -block.apex;
    for (double& elevation : block.elevations) elevation = -elevation;
    std::reverse(block.elevations.begin(), block.elevations.end());
  }
  std::reverse(beams.blocks.begin(), beams.blocks.end());
  beams.origin.z = beams.blocks.front().apex;
  return beams;
}

GroundPlane turnedOver(GroundPlane ground) {
  ground.normal.y() = -ground.normal.y();
  ground.normal.z() = -ground.normal.z();
  ground.above = false;
  return ground;
}

/// Angle between a beam and its nearer neighbour, rad.
double gapAt(const std::vector<double>& elevations, std::size_t i) {
  double gap = M_PI;
  if (i > 0) gap = std::min(gap, elevations[i - 1] - elevations[i]);
  if (i + 1 < elevations.size()) gap = std::min(gap, elevations[i] - elevations[i + 1]);
  return gap;
}

/// The preset's beams as blocks, each from its apex.
std::vector<BeamBlock> blocksOf(const SensorModel& model) {
  std::vector<BeamBlock> blocks;
  for (int row = 0; row < model.beamCount(); ++row) {
    const Beam& beam = model.beam(row);
    if (blocks.empty() || blocks.back().apex != beam.offset) blocks.push_back({beam.offset, {}});
    blocks.back().elevations.push_back(std::atan(beam.slope));
  }
  return blocks;
}

/// Matches the beams of one block: each to the nearest of the preset's, one to one.
void matchBlock(const std::vector<double>& found, const std::vector<double>& wanted, PresetFit& fit,
                double& squares, double& gaps) {
  std::vector<char> taken(wanted.size(), 0);
  for (const double elevation : found) {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < wanted.size(); ++i)
      if (std::abs(wanted[i] - elevation) < std::abs(wanted[nearest] - elevation)) nearest = i;
    const double gap = gapAt(wanted, nearest), difference = elevation - wanted[nearest];
    if (taken[nearest] || std::abs(difference) > 0.4 * gap) continue;
    taken[nearest] = 1;
    ++fit.matched;
    squares += difference * difference;
    gaps += gap;
  }
}

PresetFit fitPreset(const std::string& name, bool upsideDown, const BeamTableEstimate& beams) {
  SensorOptions options;
  options.model = name;
  options.upsideDown = upsideDown;
  const SensorModel model(options);
  const std::vector<BeamBlock> blocks = blocksOf(model);
  PresetFit fit;
  fit.model = name;
  fit.upsideDown = upsideDown;
  fit.rows = model.beamCount();
  fit.found = beams.beams();
  fit.originZ = beams.blocks.front().apex - blocks.front().apex;
  if (blocks.size() != beams.blocks.size()) return fit;
  const double apart = fit.originZ - (beams.blocks.back().apex - blocks.back().apex);
  double squares = 0, gaps = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    matchBlock(beams.blocks[b].elevations, blocks[b].elevations, fit, squares, gaps);
  if (fit.matched == 0) return fit;
  fit.rms = std::sqrt(squares / fit.matched);
  fit.rmsShare = fit.rms / (gaps / fit.matched);
  // Clouds that were corrected for motion have lost some of their sharpness.
  const bool blurred = beams.origin.slide != 0;
  fit.fits = std::abs(apart) < 0.03 && fit.matched >= (blurred ? 0.9 : 0.97) * fit.found &&
             fit.found >= 0.6 * fit.rows && fit.rmsShare < (blurred ? 0.25 : 0.15);
  return fit;
}

bool symmetrical(const SensorModel& model) {
  return std::abs(model.beam(0).slope + model.beam(model.beamCount() - 1).slope) < 0.01;
}

std::vector<PresetFit> fitPresets(const BeamTableEstimate& beams) {
  std::vector<PresetFit> fits;
  SensorOptions options;
  for (const std::string& name : SensorModel::modelNames()) {
    if (name == "table" || name == "uniform") continue;
    options.model = name;
    const bool same = symmetrical(SensorModel(options));
    fits.push_back(fitPreset(name, false, beams));
    if (!same) fits.push_back(fitPreset(name, true, beams));
  }
  const auto quality = [](const PresetFit& f) {
    return (f.fits ? 1 : 0) + static_cast<double>(f.matched) / std::max(f.rows, f.found) -
           0.5 * f.rmsShare;
  };
  std::stable_sort(fits.begin(), fits.end(),
                   [&](const PresetFit& a, const PresetFit& b) { return quality(a) > quality(b); });
  return fits;
}

double rounded(double value, double perMetre) {
  return std::round(value * perMetre) / perMetre;
}

void measureRanges(const std::vector<PointsView>& scans, SensorIdentification& result) {
  std::vector<float> ranges;
  std::vector<char> degrees(360, 0);
  for (const PointsView& scan : scans)
    for (std::size_t i = 0; i < scan.size; ++i) {
      const double x = scan.x[i] - result.beams.origin.x, y = scan.y[i] - result.beams.origin.y;
      const bool zero = scan.x[i] == 0 && scan.y[i] == 0 && scan.z[i] == 0;
      if (zero || !std::isfinite(x) || !std::isfinite(y) || !std::isfinite(scan.z[i])) {
        ++result.invalid;
        continue;
      }
      ranges.push_back(static_cast<float>(std::hypot(x, y)));
      const double turn = (std::atan2(y, x) + M_PI) / (2 * M_PI);
      degrees[std::min(359, static_cast<int>(turn * 360))] = 1;
    }
  result.points = ranges.size();
  result.covered = static_cast<double>(std::count(degrees.begin(), degrees.end(), 1)) / 360;
  const auto rank = [&](double share) {
    const double at = share * static_cast<double>(ranges.size() - 1);
    return static_cast<double>(elementOfRank(ranges, static_cast<std::size_t>(at)));
  };
  result.nearest = rank(0.01);
  result.farthest = rank(0.99);
}

void findGround(const std::vector<PointsView>& scans, SensorIdentification& result) {
  const BeamOrigin& origin = result.beams.origin;
  const Eigen::Vector3d sensor(origin.x, origin.y, origin.z);
  std::vector<GroundPlane> grounds;
  std::size_t above = 0;
  for (const PointsView& scan : scans)
    if (const auto ground = findGroundPlane(scan, sensor)) {
      grounds.push_back(*ground);
      above += ground->above;
    }
  result.onItsHead = 2 * above > grounds.size();
  grounds.erase(std::remove_if(grounds.begin(), grounds.end(),
                               [&](const GroundPlane& g) { return g.above != result.onItsHead; }),
                grounds.end());
  if (grounds.empty()) return;
  std::stable_sort(grounds.begin(), grounds.end(), [&](const GroundPlane& a, const GroundPlane& b) {
    return a.heightOf(sensor) < b.heightOf(sensor);
  });
  result.ground = grounds[grounds.size() / 2];
}

/// Identifies the LiDAR by all scans together.
SensorIdentification identifyTogether(const std::vector<PointsView>& scans) {
  SensorIdentification result;
  result.scans = scans.size();
  std::vector<PointsCopy> clouds;
  clouds.reserve(scans.size());
  for (const PointsView& scan : scans) clouds.push_back(withoutVehicle(scan));
  std::vector<PointsView> surroundings;
  surroundings.reserve(clouds.size());
  for (const PointsCopy& cloud : clouds) surroundings.push_back(cloud.view());
  result.beams = estimateBeamTable(surroundings);
  measureRanges(scans, result);
  result.columns = azimuthResolution(surroundings, result.beams);
  findGround(scans, result);
  if (result.onItsHead) {
    result.beams = turnedOver(result.beams);
    if (result.ground) result.ground = turnedOver(*result.ground);
  }
  result.presets = fitPresets(result.beams);
  return result;
}

/// The beams by the sharpest scan of those that fit a preset, if more than half fit the same one.
/// Correction for motion bends the beams of each scan by its own speed.
std::optional<SensorIdentification> identifyOneByOne(const std::vector<PointsView>& scans,
                                                     bool onItsHead) {
  std::map<std::pair<std::string, bool>, std::vector<SensorIdentification>> fitting;
  for (const PointsView& scan : scans) {
    SensorIdentification alone;
    try {
      alone = identifyTogether({scan});
    } catch (const Error&) {  // too few returns in this one alone
      continue;
    }
    const PresetFit* fit = alone.preset();
    if (fit && alone.onItsHead == onItsHead)
      fitting[{fit->model, fit->upsideDown}].push_back(std::move(alone));
  }
  for (const auto& [preset, found] : fitting)
    if (2 * found.size() > scans.size())
      return *std::max_element(found.begin(), found.end(), [](const auto& a, const auto& b) {
        return a.beams.sharpness < b.beams.sharpness;
      });
  return std::nullopt;
}

}  // namespace

const PresetFit* SensorIdentification::preset() const {
  return !presets.empty() && presets.front().fits ? &presets.front() : nullptr;
}

SensorOptions SensorIdentification::options() const {
  SensorOptions options;
  const auto significant = [](double length) {
    return std::abs(length) < 0.01 ? 0 : rounded(length, 1000);
  };
  options.originX = significant(beams.origin.x);
  options.originY = significant(beams.origin.y);
  if (const PresetFit* fit = preset()) {
    options.model = fit->model;
    options.upsideDown = fit->upsideDown;
    options.originZ = significant(fit->originZ);
    const int nominal = SensorModel(options).columns();
    if (columns > 0 && std::abs(columns - nominal) > 0.04 * nominal) options.columns = columns;
  } else {
    options.model = "table";
    options.elevations = beams.blocks.front().elevations;
    const bool two = beams.blocks.size() > 1;
    // Two blocks start a little above and below an origin that the maker chose.
    const double apex = beams.blocks.front().apex;
    options.originZ = significant(two && std::abs(apex) < 0.5 ? 0 : apex);
    if (two) {
      options.lowerElevations = beams.blocks.back().elevations;
      options.upperApex = rounded(apex - options.originZ, 1000);
      options.lowerApex = rounded(beams.blocks.back().apex - options.originZ, 1000);
    }
    options.columns = std::max(90, columns);
  }
  if (ground)
    options.height =
        rounded(ground->heightOf({options.originX, options.originY, options.originZ}), 100);
  return options;
}

SensorIdentification identifySensor(const std::vector<PointsView>& scans) {
  SensorIdentification result = identifyTogether(scans);
  if (result.preset() || scans.size() < 2) return result;
  if (const auto single = identifyOneByOne(scans, result.onItsHead)) {
    result.beams = single->beams;
    result.columns = single->columns;
    result.presets = single->presets;
  }
  return result;
}

}  // namespace polemcl
