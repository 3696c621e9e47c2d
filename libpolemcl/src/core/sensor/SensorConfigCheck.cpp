#include "core/sensor/SensorConfigCheck.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <random>
#include <set>
#include <sstream>

#include "core/common/PointsCopy.h"
#include "core/common/Statistics.h"
#include "core/sensor/GroundPlane.h"
#include "core/sensor/SensorIdentification.h"

namespace polemcl {
namespace {

constexpr int kCheckSectors = 32;
constexpr std::size_t kFewestInCell = 8;
/// In half gaps; returns of one beam scatter by 0.02 to 0.2, evenly spread ones by 0.58.
constexpr double kMixed = 0.35;
/// Least share of the beams found that have a row of the model for themselves: data-sheet angles
/// against those of a unit reach 0.8, beams of another sensor 0.5.
constexpr double kLeastAlone = 0.65;
/// Most of the returns outside the view: right presets leave out 0.01.
constexpr double kMostOutside = 0.08;

/// Less than this share of usable points does not come from a LiDAR on the ground.
constexpr double kLeastUsable = 0.05;

/// Points that are compared: enough for shares of a percent.
constexpr std::size_t kMostCompared = 32768;

/// Part of a large cloud. The steps are drawn, so that they fit no pattern of beams.
PointsCopy thinned(const PointsView& points) {
  std::minstd_rand random;
  const auto mostStep = static_cast<std::uint32_t>(2 * points.size / kMostCompared);
  PointsCopy part;
  for (std::size_t i = 0; i < points.size; i += 1 + random() % mostStep) part.add(points, i);
  return part;
}

/// Offsets of returns from a beam, in half gaps to its neighbour.
struct Offsets {
  double count = 0, sum = 0, squares = 0;
  void add(double offset) {
    ++count;
    sum += offset;
    squares += offset * offset;
  }
  double mean() const { return sum / count; }
  bool mixed() const {
    return std::sqrt(std::max(0.0, squares / count - mean() * mean())) > kMixed;
  }
};

double offsetFromBeam(const SensorModel& model, int row, double rho, double z) {
  const Beam& beam = model.beam(row);
  const double off = (z - beam.offset) / rho - beam.slope;
  int other = off > 0 ? row - 1 : row + 1;
  if (other < 0 || other >= model.beamCount()) other = off > 0 ? row + 1 : row - 1;
  const double half = 0.5 * std::abs(model.beam(other).slope - beam.slope);
  return std::clamp(off / half, -1.0, 1.0);
}

/// Rows that hold beams of the sensor, each one alone, as a share of all that should.
double shareAlone(const SensorModel& model, const BeamTableEstimate& beams) {
  std::vector<int> owners(static_cast<std::size_t>(model.beamCount()), 0);
  int first = model.beamCount(), last = -1;
  for (const BeamBlock& block : beams.blocks)
    for (const double elevation : block.elevations) {
      // A beam that starts from another height is in other rows near by than far away.
      const auto rowAt = [&](double rho) {
        return model.row(static_cast<float>(rho),
                         static_cast<float>(rho * std::tan(elevation) + block.apex));
      };
      const int row = rowAt(8);
      if (row < 0 || row != rowAt(30)) continue;
      ++owners[static_cast<std::size_t>(row)];
      first = std::min(first, row);
      last = std::max(last, row);
    }
  const double alone = static_cast<double>(std::count(owners.begin(), owners.end(), 1));
  return alone / std::max(beams.beams(), last - first + 1);
}

std::string percent(double share) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(0) << 100 * share << " %";
  return text.str();
}

std::string modelName(const std::string& model, bool upsideDown) {
  return model + (upsideDown ? " upside down" : "");
}

/// Says that nearly all points are too far or too near for [sensor]; empty otherwise.
std::string wrongUnit(const PointsView& points, const SensorOptions& options) {
  std::vector<float> ranges;
  for (std::size_t i = 0; i < points.size; ++i) {
    const float range = std::hypot(points.x[i], points.y[i]);
    if (std::isfinite(range) && range > 0) ranges.push_back(range);
  }
  if (ranges.size() < SensorConfigCheck::kFewestPoints) return {};
  const auto rank = [&](double share) {
    return elementOfRank(ranges,
                         static_cast<std::size_t>(share * static_cast<double>(ranges.size() - 1)));
  };
  const bool far = rank(kLeastUsable) > options.maxRange;
  if (!far && rank(1 - kLeastUsable) >= options.minRange) return {};
  std::ostringstream text;
  text << "nearly all points lie "
       << (far ? "beyond [sensor] max_range_m = " : "nearer than [sensor] min_range_m = ")
       << (far ? options.maxRange : options.minRange) << " m (half of them beyond " << rank(0.5)
       << " m); coordinates must be in m, not in mm or km";
  return text.str();
}

const char* kWhatToDo =
    "; `pole-extract --inspect S.rawlog --write-config F.ini` finds the right [sensor], "
    "check_beams = false uses this one anyway";

}  // namespace

bool BeamAgreement::good() const {
  return outOfView < 0.05 && emptyRows < 0.1 && mixedCells < 0.15 && meanOffset < 0.3;
}

BeamAgreement measureAgreement(const PointsView& points, const SensorModel& model, double minRange,
                               double maxRange) {
  BeamAgreement result;
  const auto rows = static_cast<std::size_t>(model.beamCount());
  std::vector<Offsets> byRow(rows), byCell(rows * kCheckSectors);
  std::size_t outside = 0;
  for (std::size_t i = 0; i < points.size; ++i) {
    const float rho = std::hypot(points.x[i], points.y[i]), z = points.z[i];
    if (!(rho > minRange && rho < maxRange) || !std::isfinite(z)) continue;
    ++result.points;
    const int row = model.row(rho, z);
    if (row < 0) {
      ++outside;
      continue;
    }
    const double offset = offsetFromBeam(model, row, rho, z);
    byRow[static_cast<std::size_t>(row)].add(offset);
    const double turn = (std::atan2(points.y[i], points.x[i]) + M_PI) / (2 * M_PI);
    const auto sector =
        static_cast<std::size_t>(std::clamp(turn * kCheckSectors, 0.0, kCheckSectors - 1.0));
    byCell[static_cast<std::size_t>(row) * kCheckSectors + sector].add(offset);
  }
  if (result.points == 0) return result;
  result.outOfView = static_cast<double>(outside) / static_cast<double>(result.points);

  const double few = std::max(10.0, 0.02 * static_cast<double>(result.points) / model.beamCount());
  const auto used = [&](const Offsets& row) { return row.count >= few; };
  const auto first = std::find_if(byRow.begin(), byRow.end(), used);
  const auto end = std::find_if(byRow.rbegin(), byRow.rend(), used).base();
  if (first >= end) return result;
  double empty = 0, mixed = 0, offsets = 0;
  for (auto row = first; row != end; ++row) {
    empty += used(*row) ? 0 : 1;
    mixed += used(*row) && row->mixed() ? 1 : 0;
    offsets += used(*row) ? std::abs(row->mean()) : 0;
  }
  const double span = static_cast<double>(end - first);
  result.emptyRows = empty / span;
  result.mixedRows = mixed / span;
  result.meanOffset = offsets / (span - empty);
  double cells = 0, mixedCells = 0;
  for (const Offsets& cell : byCell) {
    if (cell.count < kFewestInCell) continue;
    ++cells;
    mixedCells += cell.mixed() ? 1 : 0;
  }
  result.mixedCells = cells > 0 ? mixedCells / cells : 0;
  return result;
}

SensorConfigCheck::SensorConfigCheck(const SensorOptions& options, bool beams)
    : m_options(options), m_model(options), m_beams(beams) {}

std::string SensorConfigCheck::contradiction(const PointsView& points) const {
  const PointsCopy part = points.size > kMostCompared ? thinned(points) : PointsCopy();
  const PointsView compared = points.size > kMostCompared ? part.view() : points;
  if (std::string unit = wrongUnit(compared, m_options); !unit.empty()) return unit;
  const BeamAgreement agreement =
      measureAgreement(compared, m_model, m_options.minRange, m_options.maxRange);
  if (agreement.points < kFewestPoints) return {};
  const auto ground = findGroundPlane(compared);
  if (ground && ground->above)
    return "the cloud is upside down: the ground lies above the sensor; give the observation a "
           "sensor pose that says so (pole-import --sensor-pose \"0 0 0 0 0 180\"), or clouds "
           "whose z "
           "axis points up";
  if (!m_beams || agreement.good()) return {};
  return inspect(points, agreement);
}

std::string SensorConfigCheck::inspect(const PointsView& points,
                                       const BeamAgreement& agreement) const {
  std::ostringstream text;
  text << "the cloud contradicts [sensor] model = "
       << modelName(m_options.model, m_options.upsideDown) << ": " << percent(agreement.outOfView)
       << " of its points lie outside the view, " << percent(agreement.mixedRows)
       << " of the rows hold points between beams, " << percent(agreement.emptyRows)
       << " are empty; ";
  SensorIdentification inspection;
  try {
    inspection = identifySensor({points});
  } catch (const Error&) {
    if (agreement.mixedCells < 0.5 && agreement.outOfView < 0.5) return {};
    return text.str() +
           "no beams of any sensor are found in it, as after a correction for a fast motion; with "
           "check_beams = false, [sensor] is used as it is";
  }
  const double alone = shareAlone(m_model, inspection.beams);
  const PresetFit* other = inspection.preset();
  const auto own =
      std::find_if(inspection.presets.begin(), inspection.presets.end(), [&](const PresetFit& fit) {
        return fit.model == m_options.model && fit.upsideDown == m_options.upsideDown;
      });
  const bool isPreset = own != inspection.presets.end();
  const bool sameFits = isPreset && own->fits && std::abs(own->originZ) < 0.15;
  const bool rowsServe = alone >= kLeastAlone && agreement.outOfView < kMostOutside;
  if (sameFits || (rowsServe && !(isPreset && other && !own->fits))) return {};
  const auto all = inspection.beams.elevations();
  text << std::fixed << std::setprecision(1) << "it has " << all.size() << " beams from "
       << all.front() * 180 / M_PI << " to " << all.back() * 180 / M_PI << " deg";
  if (isPreset && own->fits)
    text << std::setprecision(2) << ", this model's, but from " << own->originZ
         << " m above its origin (set [sensor] origin)";
  else if (other)
    text << ", as model = " << modelName(other->model, other->upsideDown) << " has";
  return text.str() + kWhatToDo;
}

}  // namespace polemcl
