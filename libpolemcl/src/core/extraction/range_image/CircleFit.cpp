#include "core/extraction/range_image/CircleFit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace polemcl {
namespace {

/// Moments about the centroid, as both algebraic fits need them.
struct Moments {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, zz = 0;  ///< z = x² + y²
};

Moments moments(const std::vector<Eigen::Vector2d>& points) {
  Moments m;
  const double n = static_cast<double>(points.size());
  for (const auto& p : points) m.mean += p / n;
  for (const auto& p : points) {
    const Eigen::Vector2d q = p - m.mean;
    const double z = q.squaredNorm();
    m.xx += q.x() * q.x() / n;
    m.xy += q.x() * q.y() / n;
    m.yy += q.y() * q.y() / n;
    m.xz += q.x() * z / n;
    m.yz += q.y() * z / n;
    m.zz += z * z / n;
  }
  return m;
}

/// The centre solves a 2x2 system once the shift of its diagonal is known; no shift is Kåsa's fit.
std::optional<Circle> solveCircle(const Moments& m, double shift) {
  const double a = m.xx - shift, b = m.yy - shift;
  const double determinant = a * b - m.xy * m.xy;
  const double scale = m.xx + m.yy;
  if (!(std::abs(determinant) > 1e-12 * scale * scale)) return std::nullopt;
  const double x = 0.5 * (m.xz * b - m.yz * m.xy) / determinant;
  const double y = 0.5 * (m.yz * a - m.xz * m.xy) / determinant;
  const Circle circle{x + m.mean.x(), y + m.mean.y(), std::sqrt(x * x + y * y + m.xx + m.yy)};
  if (!std::isfinite(circle.radius)) return std::nullopt;
  return circle;
}

}  // namespace

std::optional<Circle> fitCircleKasa(const std::vector<Eigen::Vector2d>& points) {
  if (points.size() < 3) return std::nullopt;
  return solveCircle(moments(points), 0);
}

namespace {

template <class Real>
std::optional<Circle> fitKasaMean(const std::vector<Eigen::Vector2d>& points) {
  if (points.empty()) return std::nullopt;
  const double n = static_cast<double>(points.size());
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const auto& p : points) sum += p;
  const Eigen::Vector2d mean = sum / n;
  Eigen::Matrix2d a = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  for (const auto& p : points) {
    const Real u = static_cast<Real>(p.x()) - static_cast<Real>(mean.x());
    const Real v = static_cast<Real>(p.y()) - static_cast<Real>(mean.y());
    const Real uu = u * u, vv = v * v;
    a(0, 0) += uu;
    a(0, 1) += u * v;
    a(1, 1) += vv;
    b += 0.5 * Eigen::Vector2d(static_cast<double>(uu * u) + static_cast<double>(u * vv),
                               static_cast<double>(vv * v) + static_cast<double>(uu * v));
  }
  a(1, 0) = a(0, 1);
  const Eigen::PartialPivLU<Eigen::Matrix2d> lu(a);
  if (lu.determinant() == 0) return std::nullopt;
  const Eigen::Vector2d centre = mean + lu.solve(b);
  const Real x = static_cast<Real>(centre.x()), y = static_cast<Real>(centre.y());
  double distances = 0;
  for (const auto& p : points) {
    const Real dx = static_cast<Real>(p.x()) - x, dy = static_cast<Real>(p.y()) - y;
    distances += std::sqrt(dx * dx + dy * dy);
  }
  const Circle circle{centre.x(), centre.y(), static_cast<Real>(distances / n)};
  if (!std::isfinite(circle.radius)) return std::nullopt;
  return circle;
}

}  // namespace

std::optional<Circle> fitCircleKasaMean(const std::vector<Eigen::Vector2d>& points,
                                        bool singlePrecision) {
  return singlePrecision ? fitKasaMean<float>(points) : fitKasaMean<double>(points);
}

}  // namespace polemcl
