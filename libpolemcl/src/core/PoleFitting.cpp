#include <polemcl/core/PoleFitting.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace polemcl {
namespace {

constexpr double kRangeSigma = 0.025;  ///< m: noise of one range, and of the surface's roughness
constexpr double kRobust = 0.06;  ///< m: Cauchy scale of range residuals; mixed pixels lie beyond
constexpr double kFootprint = 0.0008;  ///< rad: by so much a beam's width widens what it sees
constexpr double kDivergence = 0.002;  ///< rad: full width of a beam
constexpr double kGrazing =
    0.85;  ///< share of the radius beyond which the front's slope is not used
constexpr double kRadiusPrior = 0.12;  ///< m: posts and trunks of streets
constexpr double kRadiusPriorSigma = 0.10;
constexpr double kFloorSigma =
    0.010;  ///< m: what no number of returns averages out (laser biases, shape)
constexpr int kIterations = 6;

struct State {
  double lateral = 0, depth = 0, radius = kRadiusPrior;
};

/// Normal equations of the cylinder in (lateral, depth, radius), seen along a reference bearing.
struct Normal {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();  ///< lower triangle
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  double residualSum = 0, weightSum = 0;
  void add(double lateral, double depth, double radius, double residual, double weight) {
    const double wl = weight * lateral, wd = weight * depth, wr = weight * radius;
    H(0, 0) += wl * lateral;
    H(1, 0) += wd * lateral;
    H(1, 1) += wd * depth;
    H(2, 0) += wr * lateral;
    H(2, 1) += wr * depth;
    H(2, 2) += wr * radius;
    g[0] += wl * residual;
    g[1] += wd * residual;
    g[2] += wr * residual;
  }
};

class CylinderProblem {
 public:
  CylinderProblem(const ScanLines& lines, const std::vector<Slice>& slices,
                  const std::vector<std::uint32_t>& used, float columnAngle)
      : m_lines(lines), m_slices(slices), m_used(used), m_columnAngle(columnAngle) {
    const Slice& reference = slices[used[used.size() / 2]];
    m_bearing = 0.5 * (reference.azimuthBegin + reference.azimuthEnd);
    m_cos = std::cos(m_bearing);
    m_sin = std::sin(m_bearing);
  }
  double cosine() const { return m_cos; }
  double sine() const { return m_sin; }

  State initial() const {
    State s;
    double sumLateral = 0, sumDepth = 0, sumWidth = 0;
    for (std::uint32_t u : m_used) {
      const Slice& slice = m_slices[u];
      sumLateral += slice.rho * offset(0.5 * (slice.azimuthBegin + slice.azimuthEnd));
      sumDepth += slice.rho;
      sumWidth += slice.rho * (slice.azimuthEnd - slice.azimuthBegin + m_columnAngle - kFootprint);
    }
    const double n = static_cast<double>(m_used.size());
    s.radius = std::clamp(0.5 * sumWidth / n, 0.02, 0.5);
    s.lateral = sumLateral / n;
    s.depth = sumDepth / n + s.radius;
    return s;
  }

  Normal normal(const State& s) const {
    Normal n;
    n.add(0, 0, 1, s.radius - kRadiusPrior, 1 / (kRadiusPriorSigma * kRadiusPriorSigma));
    for (std::uint32_t u : m_used) {
      addRanges(m_slices[u], s, n);
      addEdges(m_slices[u], s, n);
    }
    return n;
  }

 private:
  /// Azimuth against the reference bearing; a slice's azimuths differ from it by less than a turn
  /// and a half.
  double offset(double azimuth) const {
    const double d = azimuth - m_bearing;
    return d > M_PI ? d - 2 * M_PI : d < -M_PI ? d + 2 * M_PI : d;
  }

  void addRanges(const Slice& slice, const State& s, Normal& n) const {
    constexpr double kWeight = 1 / (kRangeSigma * kRangeSigma);
    const Return* row = m_lines.begin(slice.row);
    const std::size_t size = m_lines.size(slice.row);
    std::size_t i = slice.first;
    for (std::uint32_t k = 0; k < slice.count; ++k, i = i + 1 == size ? 0 : i + 1) {
      const double x = m_lines.x(row[i]), y = m_lines.y(row[i]);
      // A beam that grazes the edge hits it with the inner part of its footprint only: where the
      // return comes from is the middle of what footprint and cylinder share.
      const double half = 0.5 * kDivergence * s.depth;
      const double across = m_cos * y - m_sin * x - s.lateral;
      const double hit = 0.5 * (std::clamp(across - half, -s.radius, s.radius) +
                                std::clamp(across + half, -s.radius, s.radius));
      const double u = std::clamp(hit / s.radius, -kGrazing, kGrazing),
                   front = std::sqrt(1 - u * u);
      const double e = s.depth - s.radius * front - (m_cos * x + m_sin * y);
      const double robust = 1 / (1 + e * e / (kRobust * kRobust));
      n.add(-u / front, 1, -front, e, robust * kWeight);
      n.residualSum += robust * e * e;
      n.weightSum += robust;
    }
  }

  void addEdges(const Slice& slice, const State& s, Normal& n) const {
    const double half = 0.5 * (m_columnAngle - kFootprint);
    const double sigma = std::max(0.004, s.depth * std::sqrt(m_columnAngle * m_columnAngle / 12 +
                                                             0.16 * kFootprint * kFootprint));
    const double weight = 1 / (sigma * sigma);
    if (slice.left == Side::free)
      n.add(1, 0, 1, s.lateral + s.radius - s.depth * (offset(slice.azimuthEnd) + half), weight);
    if (slice.right == Side::free)
      n.add(1, 0, -1, s.lateral - s.radius - s.depth * (offset(slice.azimuthBegin) - half), weight);
  }

  const ScanLines& m_lines;
  const std::vector<Slice>& m_slices;
  const std::vector<std::uint32_t>& m_used;
  double m_columnAngle, m_bearing, m_cos, m_sin;
};

}  // namespace

PoleAxis roughAxis(const std::vector<Slice>& slices, const std::vector<std::uint32_t>& used,
                   float columnAngle) {
  float x = 0, y = 0, width = 0, n = 0;
  for (std::uint32_t u : used) {
    const Slice& slice = slices[u];
    x += slice.x;
    y += slice.y;
    width += slice.rho *
             (slice.azimuthEnd - slice.azimuthBegin + columnAngle - static_cast<float>(kFootprint));
    n += 1;
  }
  PoleAxis axis;
  axis.radius = std::clamp(0.5f * width / n, 0.02f, 0.5f);
  const float rho = std::sqrt(x * x + y * y) / n;
  axis.x = x / n * (1 + axis.radius / rho);
  axis.y = y / n * (1 + axis.radius / rho);
  return axis;
}

std::optional<PoleFit> fitPole(const ScanLines& lines, const std::vector<Slice>& slices,
                               const std::vector<std::uint32_t>& used, float columnAngle) {
  if (used.empty()) return std::nullopt;
  const CylinderProblem problem(lines, slices, used, columnAngle);
  State s = problem.initial();
  Normal n;
  for (int i = 0; i < kIterations; ++i) {
    n = problem.normal(s);
    n.H.triangularView<Eigen::StrictlyUpper>() = n.H.transpose();
    const Eigen::Vector3d step = n.H.inverse() * n.g;
    if (!step.allFinite()) return std::nullopt;
    s.lateral -= step[0];
    s.depth -= step[1];
    s.radius = std::clamp(s.radius - step[2], 0.005, 1.0);
    if (step.cwiseAbs().maxCoeff() < 1e-4) break;
  }
  PoleFit fit;
  const double c = problem.cosine(), sn = problem.sine();
  fit.x = static_cast<float>(s.depth * c - s.lateral * sn);
  fit.y = static_cast<float>(s.depth * sn + s.lateral * c);
  fit.radius = static_cast<float>(s.radius);
  fit.residual = static_cast<float>(std::sqrt(n.residualSum / std::max(1e-9, n.weightSum)));
  Eigen::Matrix2d turn;
  turn << -sn, c, c, sn;  // columns: lateral and depth axes in the lidar frame
  const Eigen::Matrix2d local =
      n.H.inverse().topLeftCorner<2, 2>() + kFloorSigma * kFloorSigma * Eigen::Matrix2d::Identity();
  fit.covariance = turn * local * turn.transpose();
  return fit;
}

}  // namespace polemcl
