#include "core/sensor/BeamTableEstimator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iomanip>
#include <sstream>

#include "core/common/Angles.h"
#include "core/common/Statistics.h"
#include "core/sensor/ElevationHistogram.h"

namespace polemcl {
namespace {

/// The origin of the upper block; how much deeper the lower one's is, and where they part.
struct BlockOrigins {
  BeamOrigin upper;
  bool two = false;
  double lowerZ = 0;      ///< m, of the lower block; upper.z when there is one block
  double splitSlope = 0;  ///< returns with z - (upper.z + lowerZ) / 2 < rho · splitSlope are lower
};

using Part = double BeamOrigin::*;

/// A more complicated explanation must raise the contrast by this much.
constexpr double kGain = 0.03;
/// Contrast that leaves nothing to explain.
constexpr double kSharp = 0.8;

struct Candidate {
  BeamOrigin origin;
  double contrast = 0;
};

/// The best of evenly spaced values of one part of the origin.
Candidate sweep(ElevationHistogram& spectrum, const Candidate& start, Part part, double reach,
                double step) {
  Candidate best = start;
  const double middle = start.origin.*part;
  const int steps = static_cast<int>(std::lround(reach / step));
  for (int i = -steps; i <= steps; ++i) {
    BeamOrigin origin = start.origin;
    origin.*part = middle + i * step;
    const double contrast = spectrum.contrast(origin);
    if (contrast > best.contrast) best = {origin, contrast};
  }
  return best;
}

/// Steps along each part in turn, halving the steps when none helps.
template <std::size_t count>
Candidate descend(ElevationHistogram& spectrum, Candidate best,
                  const std::array<Part, count>& parts, double step) {
  for (int halvings = 0; halvings < 6;) {
    bool better = false;
    for (const Part part : parts)
      for (const int side : {-1, 1}) {
        BeamOrigin origin = best.origin;
        origin.*part += side * step;
        const double contrast = spectrum.contrast(origin);
        if (contrast <= best.contrast) continue;
        best = {origin, contrast};
        better = true;
      }
    if (better) continue;
    step /= 2;
    ++halvings;
  }
  return best;
}

struct Split {
  double excess = -1, upperZ = 0, lowerZ = 0, slope = 0;
};

/// The place to part the slopes, and an apex for each side, that stand out most together.
Split searchSplit(ElevationHistogram& spectrum, const BeamOrigin& around) {
  constexpr int kSteps = 30;
  std::vector<std::vector<double>> sums;
  for (int i = -kSteps; i <= kSteps; ++i) {
    BeamOrigin origin = around;
    origin.z += 0.01 * i;
    sums.push_back(spectrum.cumulative(origin, around));
  }
  Split best;
  for (std::size_t cell = 0; cell < sums[0].size(); cell += 4) {
    std::size_t upper = 0, lower = 0;
    for (std::size_t i = 1; i < sums.size(); ++i) {
      if (sums[i].back() - sums[i][cell] > sums[upper].back() - sums[upper][cell]) upper = i;
      if (sums[i][cell] > sums[lower][cell]) lower = i;
    }
    const double excess = sums[upper].back() - sums[upper][cell] + sums[lower][cell];
    if (excess <= best.excess) continue;
    best = {excess, around.z + 0.01 * (static_cast<double>(upper) - kSteps),
            around.z + 0.01 * (static_cast<double>(lower) - kSteps),
            ElevationHistogram::slopeOf(cell)};
  }
  return best;
}

std::size_t cellAt(double slope, std::size_t cells) {
  std::size_t cell = 0;
  while (cell + 1 < cells && ElevationHistogram::slopeOf(cell) < slope) ++cell;
  return cell;
}

/// The apex of one side of the split to a millimetre.
double refine(ElevationHistogram& spectrum, const BeamOrigin& around, const Split& split,
              bool upper) {
  const double start = upper ? split.upperZ : split.lowerZ;
  double best = start, most = -1;
  for (int i = -10; i <= 10; ++i) {
    BeamOrigin origin = around;
    origin.z = start + 0.001 * i;
    const std::vector<double> sums = spectrum.cumulative(origin, around);
    const std::size_t cell = cellAt(split.slope, sums.size());
    const double excess = upper ? sums.back() - sums[cell] : sums[cell];
    if (excess > most) {
      most = excess;
      best = origin.z;
    }
  }
  return best;
}

/// Where the blocks part, seen from half-way between their apices: the middle of the best places.
double partingSlope(ElevationHistogram& spectrum, const BlockOrigins& blocks) {
  BeamOrigin middle = blocks.upper, lower = blocks.upper;
  middle.z = 0.5 * (blocks.upper.z + blocks.lowerZ);
  lower.z = blocks.lowerZ;
  const std::vector<double> above = spectrum.cumulative(blocks.upper, middle);
  const std::vector<double> below = spectrum.cumulative(lower, middle);
  double most = 0;
  for (std::size_t cell = 0; cell < above.size(); ++cell)
    most = std::max(most, above.back() - above[cell] + below[cell]);
  std::size_t first = above.size(), last = 0;
  for (std::size_t cell = 0; cell < above.size(); ++cell)
    if (above.back() - above[cell] + below[cell] > most - 1e-6 * most) {
      first = std::min(first, cell);
      last = cell;
    }
  return 0.5 * (ElevationHistogram::slopeOf(first) + ElevationHistogram::slopeOf(last));
}

/// What one place of the sensor explains, with one block of beams or, if that is clearly better,
/// two.
struct Explanation {
  BlockOrigins blocks;
  double contrast = 0;
};

Explanation explain(ElevationHistogram& spectrum, const BeamOrigin& origin) {
  const double points = static_cast<double>(spectrum.size());
  Explanation found;
  found.blocks.upper = origin;
  found.blocks.lowerZ = origin.z;
  found.contrast = spectrum.cumulative(origin, origin).back() / points;
  const Split split = searchSplit(spectrum, origin);
  if (split.excess / points < found.contrast + kGain ||
      std::abs(split.upperZ - split.lowerZ) < 0.03)
    return found;
  found.contrast = split.excess / points;
  found.blocks.two = true;
  found.blocks.upper.z = refine(spectrum, origin, split, true);
  found.blocks.lowerZ = refine(spectrum, origin, split, false);
  found.blocks.splitSlope = partingSlope(spectrum, found.blocks);
  return found;
}

/// Searches heights of ±2.5 m, then places of ±2 m, the slide of motion-corrected clouds, and two
/// blocks, keeping only what makes the beams clearly sharper.
BlockOrigins searchOrigins(ElevationHistogram& spectrum) {
  const auto z = &BeamOrigin::z, x = &BeamOrigin::x, y = &BeamOrigin::y, slide = &BeamOrigin::slide;
  Candidate own;
  own.contrast = spectrum.contrast(own.origin);
  Candidate high = descend(spectrum, sweep(spectrum, own, z, 2.5, 0.02), std::array{z}, 0.01);
  if (own.contrast > high.contrast - 0.1 * kGain) high = own;
  Explanation best = explain(spectrum, high.origin);
  if (best.contrast > kSharp) return best.blocks;

  const Candidate slid =
      descend(spectrum, sweep(spectrum, high, slide, 3.0, 0.1), std::array{slide, z}, 0.05);
  Candidate moved = sweep(spectrum, sweep(spectrum, high, x, 2.0, 0.05), y, 1.0, 0.05);
  moved = descend(spectrum, moved, std::array{x, y, z}, 0.02);
  for (const Candidate& candidate : {slid, moved}) {
    if (candidate.contrast < high.contrast + kGain) continue;
    const Explanation other = explain(spectrum, candidate.origin);
    if (other.contrast > best.contrast + kGain) best = other;
  }
  return best.blocks;
}

constexpr std::size_t kFewestReturns = 2000;  // returns to search beams among
constexpr std::size_t kSearchSample = 20000;  // returns the origin is searched with
constexpr double kSearchRho = 3;              // m; nearer ones tell little of the origin
constexpr double kCell = 0.005 * degree;      // of the histogram of elevations
constexpr double kKernel = 0.03 * degree;     // its smoothing, a tenth of the narrowest gap in use
constexpr std::size_t kCells = 36000;         // 180°
constexpr double kLeastSharpness =
    0.82;                           // single scans 0.9 to 1, merged or thinned ones up to 0.75
constexpr double kFullWeight = 20;  // m

bool counts(float x, float y, float z) {
  const double squared = static_cast<double>(x) * x + static_cast<double>(y) * y;
  return std::isfinite(squared) && std::isfinite(z) && squared > 0.25 &&
         squared + static_cast<double>(z) * z > 1;
}

std::uint32_t hashOf(const BeamPoint& p) {
  std::uint64_t h = 0x9e3779b97f4a7c15ull;
  for (const float value : {p.x, p.y, p.z}) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    h = (h ^ bits) * 0xd6e8feb86659fd93ull;
    h ^= h >> 32;
  }
  return static_cast<std::uint32_t>(h);
}

std::vector<BeamPoint> usablePoints(const std::vector<PointsView>& scans) {
  std::vector<BeamPoint> points;
  for (const PointsView& scan : scans)
    for (std::size_t i = 0; i < scan.size; ++i)
      if (counts(scan.x[i], scan.y[i], scan.z[i]))
        points.push_back({scan.x[i], scan.y[i], scan.z[i]});
  return points;
}

/// A sample that depends on the points only, not on their order.
std::vector<BeamPoint> sampleOf(const std::vector<BeamPoint>& points) {
  std::vector<BeamPoint> far;
  for (const BeamPoint& p : points)
    if (std::hypot(p.x, p.y) > kSearchRho) far.push_back(p);
  if (far.size() <= kSearchSample) return far;
  const double share = static_cast<double>(kSearchSample) / static_cast<double>(far.size());
  const auto limit = static_cast<std::uint32_t>(share * 4294967295.0);
  far.erase(
      std::remove_if(far.begin(), far.end(), [&](const BeamPoint& p) { return hashOf(p) > limit; }),
      far.end());
  return far;
}

using Cells = std::vector<float>;

/// Returns per cell of elevation, of one block: how many, and how much they tell. What is left of
/// the lasers' own origins smears near returns, so far ones count more.
struct Histogram {
  Cells counts, weights;
};

double elevationOf(std::size_t cell) {
  return -M_PI / 2 + (static_cast<double>(cell) + 0.5) * kCell;
}

struct Elevation {
  double angle, rho;
  bool lower;
};
Elevation elevationOf(const BeamPoint& point, const BlockOrigins& blocks) {
  const BeamCoordinates at = beamCoordinates(point, blocks.upper);
  const double middle = 0.5 * (blocks.lowerZ - blocks.upper.z);
  const bool lower = blocks.two && at.z - middle < at.rho * blocks.splitSlope;
  return {std::atan2(lower ? at.z + blocks.upper.z - blocks.lowerZ : at.z, at.rho), at.rho, lower};
}

Histogram histogram(const std::vector<BeamPoint>& points, const BlockOrigins& blocks, bool lower) {
  Histogram out{Cells(kCells, 0), Cells(kCells, 0)};
  for (const BeamPoint& point : points) {
    const Elevation e = elevationOf(point, blocks);
    if (e.lower != lower) continue;
    const double place = std::max(0.0, (e.angle + M_PI / 2) / kCell);
    const std::size_t cell = std::min(kCells - 1, static_cast<std::size_t>(place));
    ++out.counts[cell];
    // Whole numbers, so that their sums do not depend on the order of the points.
    out.weights[cell] += static_cast<float>(std::floor(std::clamp(e.rho, 1.0, kFullWeight)));
  }
  return out;
}

Cells smoothed(const Cells& cells) {
  const int reach = static_cast<int>(3 * kKernel / kCell);
  std::vector<float> weights;
  for (int k = -reach; k <= reach; ++k)
    weights.push_back(static_cast<float>(std::exp(-0.5 * std::pow(k * kCell / kKernel, 2))));
  Cells out(cells.size(), 0);
  for (int i = reach; i + reach < static_cast<int>(cells.size()); ++i) {
    if (cells[i] == 0) continue;
    for (int k = -reach; k <= reach; ++k) out[i + k] += weights[k + reach] * cells[i];
  }
  return out;
}

/// Cells of the maxima that stand out of the valleys beside them by at least half their height
/// (persistence of one-dimensional maxima), in ascending order.
std::vector<std::size_t> maxima(const Cells& heights) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < heights.size(); ++i)
    if (heights[i] > 0) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return heights[a] > heights[b]; });
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> parent(heights.size(), kNone);  // towards the top of its hill
  const auto top = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::vector<char> isBeam(heights.size(), 0);
  for (const std::size_t i : order) {
    const std::size_t left = i > 0 && parent[i - 1] != kNone ? top(i - 1) : kNone;
    const std::size_t right = i + 1 < heights.size() && parent[i + 1] != kNone ? top(i + 1) : kNone;
    parent[i] = i;
    isBeam[i] = left == kNone && right == kNone;
    if (left != kNone && right != kNone && left != right) {
      const std::size_t high = heights[left] >= heights[right] ? left : right;
      const std::size_t low = high == left ? right : left;
      if (heights[low] < 2 * heights[i]) isBeam[low] = 0;
      parent[low] = high;
    }
    if (left != kNone || right != kNone) parent[i] = left != kNone ? top(left) : top(right);
  }
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < heights.size(); ++i)
    if (isBeam[i]) found.push_back(i);
  return found;
}

/// Mean elevation of the returns around each maximum, up to half-way to the next; maxima of too few
/// returns are dropped.
std::vector<double> peaksOf(const Histogram& returns) {
  const std::vector<std::size_t> tops = maxima(smoothed(returns.weights));
  std::vector<double> elevations, masses;
  for (std::size_t i = 0; i < tops.size(); ++i) {
    const auto reach = static_cast<std::size_t>(2.5 * kKernel / kCell);
    std::size_t from = tops[i] - std::min(tops[i], reach),
                to = std::min(kCells, tops[i] + reach + 1);
    if (i > 0) from = std::max(from, (tops[i - 1] + tops[i]) / 2);
    if (i + 1 < tops.size()) to = std::min(to, (tops[i] + tops[i + 1]) / 2);
    double weight = 0, moment = 0, mass = 0;
    for (std::size_t c = from; c < to; ++c) {
      mass += returns.counts[c];
      weight += returns.weights[c];
      moment += returns.weights[c] * elevationOf(c);
    }
    elevations.push_back(weight > 0 ? moment / weight : 0);
    masses.push_back(mass);
  }
  std::vector<double> sorted = masses;
  std::sort(sorted.begin(), sorted.end());
  const double typical = sorted.empty() ? 0 : sorted[sorted.size() * 3 / 4];
  std::vector<double> kept;
  for (std::size_t i = tops.size(); i-- > 0;)
    if (masses[i] >= std::max(10.0, 0.02 * typical)) kept.push_back(elevations[i]);
  return kept;  // topmost first
}

/// How far returns lie from their beams.
void measureSharpness(const std::vector<BeamPoint>& points, const BlockOrigins& blocks,
                      BeamTableEstimate& estimate) {
  std::vector<double> all = estimate.elevations();
  std::reverse(all.begin(), all.end());
  std::vector<float> deviations;
  std::size_t near = 0;
  for (const BeamPoint& point : points) {
    const auto [e, rho, lower] = elevationOf(point, blocks);
    if (rho < kSearchRho) continue;
    const auto above = std::lower_bound(all.begin(), all.end(), e);
    const auto i = static_cast<std::size_t>(above - all.begin());
    const bool up = i == 0 || (i < all.size() && all[i] - e < e - all[i - 1]);
    const std::size_t beam = up ? i : i - 1;
    const std::size_t a = std::clamp<std::size_t>(i, 1, all.size() - 1);
    const double cell = 0.5 * (all[a] - all[a - 1]), deviation = std::abs(e - all[beam]);
    near += deviation < cell / 3;
    deviations.push_back(static_cast<float>(deviation));
  }
  estimate.spread = elementOfRank(deviations, deviations.size() / 2);
  estimate.sharpness = static_cast<double>(near) / static_cast<double>(deviations.size());
}

[[noreturn]] void refuseEstimate(const BeamTableEstimate& estimate) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1)
       << "no beams: the returns do not lie on cones about the z axis of their frame; of the best "
       << estimate.beams() << " found, only " << 100 * estimate.sharpness
       << " % of the returns lie near one (" << 100 * kLeastSharpness
       << " % are needed). Merged, voxel-thinned, noisy or levelled clouds have none, nor have "
          "those that were corrected for a fast motion; give single scans as the sensor measured "
          "them, in its own axes, or set [sensor] model to this LiDAR, such as os0_64 "
          "(share/doc/lidars.md)";
  throw Error(text.str());
}

}  // namespace

int BeamTableEstimate::beams() const {
  return static_cast<int>(elevations().size());
}

std::vector<double> BeamTableEstimate::elevations() const {
  std::vector<double> all;
  for (const BeamBlock& block : blocks)
    all.insert(all.end(), block.elevations.begin(), block.elevations.end());
  std::sort(all.rbegin(), all.rend());
  return all;
}

BeamTableEstimate estimateBeamTable(const std::vector<PointsView>& scans) {
  const std::vector<BeamPoint> points = usablePoints(scans);
  ElevationHistogram spectrum(sampleOf(points));
  if (spectrum.size() < kFewestReturns)
    throw Error("only " + std::to_string(spectrum.size()) +
                " valid points farther than 3 m: at least " + std::to_string(kFewestReturns) +
                " are needed to find the beams");
  const BlockOrigins blocks = searchOrigins(spectrum);
  BeamTableEstimate estimate;
  estimate.origin = blocks.upper;
  estimate.points = points.size();
  estimate.blocks.push_back({blocks.upper.z, peaksOf(histogram(points, blocks, false))});
  if (blocks.two)
    estimate.blocks.push_back({blocks.lowerZ, peaksOf(histogram(points, blocks, true))});
  if (estimate.beams() >= 2) measureSharpness(points, blocks, estimate);
  if (estimate.beams() < 2 || estimate.sharpness < kLeastSharpness) refuseEstimate(estimate);
  return estimate;
}

}  // namespace polemcl
