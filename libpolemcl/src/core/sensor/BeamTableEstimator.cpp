#include "core/sensor/BeamTableEstimator.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iomanip>
#include <sstream>

#include "core/common/Angles.h"
#include "core/common/Statistics.h"
#include "core/sensor/BeamOriginSearch.h"

namespace polemcl {
namespace {

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
  text << std::fixed << std::setprecision(0)
       << "no beams: the returns do not lie on cones about the z axis of their frame; of the best "
       << estimate.beams() << " found, only " << 100 * estimate.sharpness
       << " % of the returns lie near one (" << 100 * kLeastSharpness
       << " % are needed). Merged, voxel-thinned, noisy or levelled clouds have none, nor have "
          "those that were corrected for a fast motion; give single scans as the sensor measured "
          "them, in its own axes, or take a configuration of this LiDAR (share/doc/lidars.md)";
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
