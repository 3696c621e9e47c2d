#include "core/evaluation/MultiScanLabels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace polemcl {
namespace {

constexpr double kReach = 0.8;         ///< points farther from a place do not count, m
constexpr double kCore = 0.3;          ///< middle of a place, m
constexpr double kFarthest = 25;       ///< points farther from the sensor are too sparse, m
constexpr double kNearPass = 20;       ///< m
constexpr double kCell = 0.05;         ///< side of a voxel, m
constexpr double kLayer = 0.1;         ///< height of a voxel, m
constexpr int kWidth = 33;             ///< voxels from side to side of a place
constexpr int kLowestLayer = -100000;  ///< 10 km below the origin; a key holds ten times that
constexpr int kSides = 16;
constexpr double kGridCell = 2;

// Heights above ground, m, and what a pole must have. Chosen once, by what a pole is.
constexpr double kFoot = 0.6, kSlice = 0.2;
constexpr int kSlices = 10;         ///< from kFoot: up to 2.6 m
constexpr int kBody = 6;            ///< of them that a wide thing fills: up to 1.8 m
constexpr int kLeastSlim = 5;       ///< slices one above the other that make a pole
constexpr int kLeastWide = 4;       ///< of kBody
constexpr int kGap = 3;             ///< voxels: things nearer belong together
constexpr double kSlim = 0.75;      ///< greatest width of a slim slice, m
constexpr double kCompact = 0.42;   ///< share of the cells in the middle: a wall has less
constexpr float kOffGround = 0.5f;  ///< points below, above the lowest one, may be ground, m
constexpr double kLow = 1.5;        ///< what ends below is no pole, m
constexpr double kHigh = 2.2;       ///< height that beams must reach to say that it ends there, m
constexpr double kMostLean = 0.15;  ///< m per m
constexpr double kMostBend = 0.08;  ///< rms distance of the slices from a straight line, m
constexpr unsigned kLeastScans = 3, kLeastSides = 3, kManyPasses = 8;

std::int64_t gridKey(std::int64_t x, std::int64_t y) {
  return x * 0x100000000ll + y;
}
std::int64_t gridIndex(double value) {
  return static_cast<std::int64_t>(std::floor(value / kGridCell));
}

struct Voxel {
  int x, y, layer;
};
std::uint32_t packed(const Voxel& v) {
  return static_cast<std::uint32_t>(((v.layer - kLowestLayer) * kWidth + v.x) * kWidth + v.y);
}
Voxel unpacked(std::uint32_t key) {
  const int k = static_cast<int>(key);
  return {k / kWidth % kWidth, k % kWidth, k / kWidth / kWidth + kLowestLayer};
}
double middleOf(int cell) {
  const int middle = kWidth / 2;
  return (cell - middle) * kCell;
}

/// What stands at the middle of a place in a slice of heights.
struct Slice {
  enum class Kind { empty, slim, wide, mixed } kind = Kind::empty;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
};

using Cells = std::array<std::array<bool, kWidth>, kWidth>;

/// Grows from a cell over cells not farther than kGap; the cells found are cleared.
std::vector<std::pair<int, int>> takeComponent(Cells& cells, int x, int y) {
  std::vector<std::pair<int, int>> found{{x, y}};
  cells[x][y] = false;
  for (std::size_t i = 0; i < found.size(); ++i)
    for (int u = std::max(0, found[i].first - kGap);
         u <= std::min(kWidth - 1, found[i].first + kGap); ++u)
      for (int v = std::max(0, found[i].second - kGap);
           v <= std::min(kWidth - 1, found[i].second + kGap); ++v)
        if (cells[u][v]) {
          cells[u][v] = false;
          found.emplace_back(u, v);
        }
  return found;
}

Slice sliceOf(Cells cells) {
  int all = 0, bestX = -1, bestY = -1;
  double nearest = kCore;
  for (int x = 0; x < kWidth; ++x)
    for (int y = 0; y < kWidth; ++y) {
      all += cells[x][y];
      const double distance = std::hypot(middleOf(x), middleOf(y));
      if (!cells[x][y] || distance >= nearest) continue;
      nearest = distance;
      bestX = x;
      bestY = y;
    }
  Slice slice;
  if (bestX < 0) return slice;
  const auto own = takeComponent(cells, bestX, bestY);
  int left = kWidth, right = 0, low = kWidth, high = 0;
  bool atBorder = false;
  int inCore = 0;
  for (const auto& [x, y] : own) {
    left = std::min(left, x);
    right = std::max(right, x);
    low = std::min(low, y);
    high = std::max(high, y);
    slice.centre += Eigen::Vector2d(middleOf(x), middleOf(y)) / static_cast<double>(own.size());
    inCore += std::hypot(middleOf(x), middleOf(y)) < kCore;
    atBorder |= std::hypot(middleOf(x), middleOf(y)) > kReach - 0.1;
  }
  const double width = kCell * (std::max(right - left, high - low) + 1);
  const int size = static_cast<int>(own.size());
  if (atBorder || width > 1)
    slice.kind = inCore < kCompact * size ? Slice::Kind::wide : Slice::Kind::mixed;
  else if (width <= kSlim && all - size <= 2 * size)
    slice.kind = Slice::Kind::slim;
  else
    slice.kind = Slice::Kind::mixed;
  return slice;
}

/// The longest run of slim slices one above the other: [first, last).
struct Run {
  int first = 0, last = 0;
  int length() const { return last - first; }
};

Run longestRun(const std::vector<Slice>& slices) {
  Run best, run;
  for (int s = 0; s < kSlices; ++s) {
    if (slices[s].kind != Slice::Kind::slim)
      run = {s + 1, s + 1};
    else if (++run.last; run.length() > best.length())
      best = run;
  }
  return best;
}

/// Whether the centres of a run of slices lie on one nearly upright line.
bool straight(const std::vector<Slice>& slices, const Run& run) {
  Eigen::Matrix<double, Eigen::Dynamic, 2> lines(run.length(), 2), centres(run.length(), 2);
  for (int s = run.first; s < run.last; ++s) {
    lines.row(s - run.first) << 1, s * kSlice;
    centres.row(s - run.first) = slices[s].centre.transpose();
  }
  const Eigen::Matrix2d fit = (lines.transpose() * lines).inverse() * (lines.transpose() * centres);
  const double bend = std::sqrt((centres - lines * fit).squaredNorm() / run.length());
  return fit.row(1).norm() <= kMostLean && bend <= kMostBend;
}

/// A slim and straight run that reaches 1.8 m, on the ground or on something wider (hedge, fence).
bool standsFree(const std::vector<Slice>& slices, const Run& run) {
  if (run.length() < kLeastSlim || run.last < kBody) return false;
  for (int s = 0; s < run.first; ++s)
    if (slices[s].kind == Slice::Kind::empty) return false;
  return straight(slices, run);
}

unsigned bitsOf(std::uint16_t sides) {
  unsigned count = 0;
  for (; sides; sides &= static_cast<std::uint16_t>(sides - 1)) ++count;
  return count;
}

}  // namespace

MultiScanLabels::MultiScanLabels(std::vector<Eigen::Vector2d> places)
    : m_centres(std::move(places)), m_places(m_centres.size()) {
  for (std::size_t i = 0; i < m_centres.size(); ++i)
    m_grid[gridKey(gridIndex(m_centres[i].x()), gridIndex(m_centres[i].y()))].push_back(
        static_cast<std::uint32_t>(i));
}

void MultiScanLabels::addTo(Place& place, const Eigen::Vector2d& centre,
                            const Eigen::Vector3f& point, std::uint16_t side) {
  const double x = point.x() - centre.x(), y = point.y() - centre.y();
  if (x * x + y * y > kReach * kReach) return;
  const int layer = static_cast<int>(std::floor(point.z() / kLayer));
  if (std::abs(layer) >= -kLowestLayer) return;
  const Voxel voxel{static_cast<int>(std::lround(x / kCell)) + kWidth / 2,
                    static_cast<int>(std::lround(y / kCell)) + kWidth / 2, layer};
  place.voxels[packed(voxel)] |= side;
  place.low = std::min(place.low, point.z());
  if (x * x + y * y > kCore * kCore || point.z() < place.low + kOffGround ||
      place.lastScan == m_scans)
    return;
  place.lastScan = m_scans;
  ++place.scans;
}

void MultiScanLabels::add(const std::vector<Eigen::Vector3f>& points_map,
                          const Eigen::Vector3d& sensor_map, double topSlope) {
  ++m_scans;
  for (std::size_t i = 0; i < m_places.size(); ++i) {
    const double distance = (m_centres[i] - sensor_map.head<2>()).norm();
    if (distance > kNearPass) continue;
    ++m_places[i].passes;
    m_places[i].reach =
        std::max(m_places[i].reach, static_cast<float>(sensor_map.z() + topSlope * distance));
  }
  for (const Eigen::Vector3f& point : points_map) {
    const double dx = point.x() - sensor_map.x(), dy = point.y() - sensor_map.y();
    if (dx * dx + dy * dy > kFarthest * kFarthest) continue;
    const int sector = static_cast<int>((std::atan2(dy, dx) / M_PI + 1) * kSides / 2);
    const auto side = static_cast<std::uint16_t>(1u << std::min(sector, kSides - 1));
    for (auto x = gridIndex(point.x() - kReach); x <= gridIndex(point.x() + kReach); ++x)
      for (auto y = gridIndex(point.y() - kReach); y <= gridIndex(point.y() + kReach); ++y) {
        const auto cell = m_grid.find(gridKey(x, y));
        if (cell == m_grid.end()) continue;
        for (const std::uint32_t i : cell->second) addTo(m_places[i], m_centres[i], point, side);
      }
  }
}

std::vector<Standing> MultiScanLabels::judge() const {
  std::vector<Standing> verdicts;
  verdicts.reserve(m_places.size());
  for (const Place& place : m_places) verdicts.push_back(judge(place));
  return verdicts;
}

Standing MultiScanLabels::judge(const Place& place) const {
  if (place.voxels.size() < 20) return Standing::unsure;
  std::vector<int> layers;
  layers.reserve(place.voxels.size());
  for (const auto& voxel : place.voxels) layers.push_back(unpacked(voxel.first).layer);
  std::sort(layers.begin(), layers.end());
  const double ground = layers[layers.size() / 50] * kLayer;
  std::vector<Cells> cells(kSlices, Cells{});
  std::uint16_t sides = 0;
  double top = 0;
  for (const auto& [key, seen] : place.voxels) {
    const Voxel voxel = unpacked(key);
    const double height = (voxel.layer + 0.5) * kLayer - ground;
    const bool core = std::hypot(middleOf(voxel.x), middleOf(voxel.y)) < kCore;
    top = std::max(top, height);
    const int slice = static_cast<int>(std::floor((height - kFoot) / kSlice));
    if (slice < 0 || slice >= kSlices) continue;
    cells[slice][voxel.x][voxel.y] = true;
    if (core) sides |= seen;
  }
  std::vector<Slice> slices;
  slices.reserve(kSlices);
  for (const Cells& each : cells) slices.push_back(sliceOf(each));
  const auto wide = std::count_if(slices.begin(), slices.begin() + kBody, [](const Slice& slice) {
    return slice.kind == Slice::Kind::wide;
  });
  const Run run = longestRun(slices);
  if (place.passes >= kManyPasses && place.scans <= 2) return Standing::other;
  if (place.scans < kLeastScans) return Standing::unsure;
  if (wide >= kLeastWide && run.length() < 2) return Standing::other;
  if (top < kLow && place.reach - ground > kHigh) return Standing::other;
  if (bitsOf(sides) >= kLeastSides && standsFree(slices, run)) return Standing::pole;
  return Standing::unsure;
}

}  // namespace polemcl
