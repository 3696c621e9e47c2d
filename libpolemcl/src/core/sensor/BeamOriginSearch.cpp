#include "core/sensor/BeamOriginSearch.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace polemcl {
namespace {

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

}  // namespace

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

}  // namespace polemcl
