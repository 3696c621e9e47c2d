#include "core/sensor/GroundPlane.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace polemcl {
namespace {

constexpr int kSectors = 60, kRings = 12;
constexpr double kRingWidth = 2, kNearest = 1;  // m
constexpr double kInlier = 0.15;                // m: kerbs, and what a street bends
constexpr double kMostLevel = 0.906;            // cosine of 25°
constexpr double kLeastShare = 0.25;
constexpr double kLeastHeight = 0.1;  // m, of the sensor over the ground
constexpr double kHeadShare = 0.35;   // least share of ground that is overhead
constexpr double kMostBelow = 0.2;    // of what lies below then: more is a floor
constexpr int kTrials = 400;

using Points = std::vector<Eigen::Vector3d>;

/// The lowest return of each cell of a polar grid; the highest, when `side` is -1.
Points outermost(const PointsView& points, const Eigen::Vector3d& sensor, double side) {
  const double none = std::numeric_limits<double>::infinity();
  std::vector<Eigen::Vector3d> lowest(kSectors * kRings, Eigen::Vector3d(0, 0, none));
  for (std::size_t i = 0; i < points.size; ++i) {
    const Eigen::Vector3d p(points.x[i] - sensor.x(), points.y[i] - sensor.y(),
                            side * (points.z[i] - sensor.z()));
    const double rho = std::hypot(p.x(), p.y());
    if (!p.allFinite() || rho < kNearest || rho >= kRings * kRingWidth) continue;
    const double turn = (std::atan2(p.y(), p.x()) + M_PI) / (2 * M_PI);
    const int sector = std::min(kSectors - 1, static_cast<int>(turn * kSectors));
    Eigen::Vector3d& cell = lowest[sector * kRings + static_cast<int>(rho / kRingWidth)];
    const bool before = p.x() != cell.x() ? p.x() < cell.x() : p.y() < cell.y();
    if (p.z() < cell.z() || (p.z() == cell.z() && before)) cell = p;
  }
  Points found;
  for (const Eigen::Vector3d& p : lowest)
    if (std::isfinite(p.z())) found.push_back(p);
  return found;
}

/// Draws the same numbers in the same order each time; which ones does not matter.
struct Draw {
  std::uint64_t state = 0x2545f4914f6cdd1dull;
  std::size_t below(std::size_t n) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<std::size_t>((state >> 33) % n);
  }
};

struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0;
  std::size_t inliers = 0;
  bool usable() const { return normal.z() >= kMostLevel && offset >= kLeastHeight; }
};

std::size_t countInliers(const Points& points, const Plane& plane) {
  return static_cast<std::size_t>(
      std::count_if(points.begin(), points.end(), [&](const Eigen::Vector3d& p) {
        return std::abs(plane.normal.dot(p) + plane.offset) < kInlier;
      }));
}

Plane through(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  Plane plane;
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  if (!(normal.norm() > 1e-6)) return plane;
  plane.normal = normal.normalized() * (normal.z() < 0 ? -1 : 1);
  plane.offset = -plane.normal.dot(a);
  return plane;
}

/// Least squares through the inliers.
Plane refined(const Points& points, const Plane& rough) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Points inliers;
  for (const Eigen::Vector3d& p : points)
    if (std::abs(rough.normal.dot(p) + rough.offset) < kInlier) {
      inliers.push_back(p);
      mean += p;
    }
  if (inliers.size() < 3) return rough;
  mean /= static_cast<double>(inliers.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : inliers) scatter += (p - mean) * (p - mean).transpose();
  const Eigen::Vector3d normal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
  Plane plane;
  plane.normal = normal * (normal.z() < 0 ? -1 : 1);
  plane.offset = -plane.normal.dot(mean);
  plane.inliers = countInliers(points, plane);
  return plane.usable() && plane.inliers >= rough.inliers ? plane : rough;
}

Plane bestPlane(const Points& points) {
  Plane best;
  if (points.size() < 12) return best;
  Draw draw;
  for (int trial = 0; trial < kTrials; ++trial) {
    const std::size_t a = draw.below(points.size()), b = draw.below(points.size()),
                      c = draw.below(points.size());
    Plane plane = through(points[a], points[b], points[c]);
    if (!plane.usable()) continue;
    plane.inliers = countInliers(points, plane);
    if (plane.inliers > best.inliers) best = plane;
  }
  for (int pass = 0; pass < 3 && best.inliers > 0; ++pass) best = refined(points, best);
  return best;
}

/// The lowest of a cell is lower than the ground by some noise: moves the plane to the mean of all
/// returns beside it. Summed in whole tenths of a millimetre, so that their order does not matter.
double meanResidual(const PointsView& points, const Eigen::Vector3d& sensor, double side,
                    const Plane& plane) {
  constexpr double kUnit = 1e-4, kBand = 0.1;  // m
  std::int64_t sum = 0, count = 0;
  for (std::size_t i = 0; i < points.size; ++i) {
    const Eigen::Vector3d p(points.x[i] - sensor.x(), points.y[i] - sensor.y(),
                            side * (points.z[i] - sensor.z()));
    const double residual = plane.normal.dot(p) + plane.offset;
    if (!(std::abs(residual) < kBand) || std::hypot(p.x(), p.y()) > kRings * kRingWidth) continue;
    sum += std::llround(residual / kUnit);
    ++count;
  }
  return count > 0 ? kUnit * static_cast<double>(sum) / static_cast<double>(count) : 0;
}

GroundPlane groundOn(const PointsView& points, const Eigen::Vector3d& sensor, double side) {
  const Points lowest = outermost(points, sensor, side);
  Plane plane = bestPlane(lowest);
  if (plane.inliers > 0) plane.offset -= meanResidual(points, sensor, side, plane);
  GroundPlane ground;
  ground.normal = Eigen::Vector3d(plane.normal.x(), plane.normal.y(), side * plane.normal.z());
  ground.offset = plane.offset - ground.normal.dot(sensor);
  ground.above = side < 0;
  ground.share =
      lowest.empty() ? 0 : static_cast<double>(plane.inliers) / static_cast<double>(lowest.size());
  return ground;
}

}  // namespace

double GroundPlane::roll() const {
  const double side = above ? -1 : 1;
  return std::atan2(side * normal.y(), side * normal.z());
}

double GroundPlane::pitch() const {
  return -std::asin(std::clamp(normal.x(), -1.0, 1.0));
}

std::optional<GroundPlane> findGroundPlane(const PointsView& points,
                                           const Eigen::Vector3d& sensor) {
  const GroundPlane below = groundOn(points, sensor, 1), above = groundOn(points, sensor, -1);
  // A ceiling is a plane, too, but there is a floor under it, though cars may hide much of it.
  const bool onItsHead = above.share >= kHeadShare && below.share < kMostBelow;
  const GroundPlane& ground = onItsHead ? above : below;
  if (ground.share < kLeastShare) return std::nullopt;
  return ground;
}

}  // namespace polemcl
