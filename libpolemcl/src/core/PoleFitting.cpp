#include <polemcl/core/PoleFitting.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace polemcl {
namespace {

constexpr double kRangeSigma = 0.025;  ///< m: noise of one range, and of the surface's roughness
constexpr double kRobust = 0.06;  ///< m: Cauchy scale of range residuals; mixed pixels lie beyond
constexpr double kFootprint = 0.0015;  ///< rad: by so much a beam's width widens what it sees
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
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  void add(const Eigen::Vector3d& jacobian, double residual, double weight) {
    H += weight * jacobian * jacobian.transpose();
    g += weight * residual * jacobian;
  }
};

class CylinderProblem {
 public:
  CylinderProblem(const ScanLines& lines, const std::vector<Slice>& slices,
                  const std::vector<std::uint32_t>& used, float columnAngle)
      : m_lines(lines), m_slices(slices), m_used(used), m_columnAngle(columnAngle) {
    const Slice& reference = slices[used[used.size() / 2]];
    m_bearing = 0.5 * (reference.azimuthBegin + reference.azimuthEnd);
  }
  double bearing() const { return m_bearing; }

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

  Normal normal(const State& s, double* residualSum, double* weightSum) const {
    Normal n;
    n.add({0, 0, 1}, s.radius - kRadiusPrior, 1 / (kRadiusPriorSigma * kRadiusPriorSigma));
    for (std::uint32_t u : m_used) {
      addRanges(m_slices[u], s, n, residualSum, weightSum);
      addEdges(m_slices[u], s, n);
    }
    return n;
  }

 private:
  double offset(double azimuth) const { return std::remainder(azimuth - m_bearing, 2 * M_PI); }

  void addRanges(const Slice& slice, const State& s, Normal& n, double* residualSum,
                 double* weightSum) const {
    const Return* row = m_lines.begin(slice.row);
    const std::size_t size = m_lines.size(slice.row);
    for (std::uint32_t k = 0; k < slice.count; ++k) {
      const Return& r = row[(slice.first + k) % size];
      const double angle = offset(r.azimuth);
      const double dLateral = r.rho * std::sin(angle) - s.lateral;
      const double dDepth = r.rho * std::cos(angle) - s.depth;
      const double distance = std::max(1e-3, std::hypot(dLateral, dDepth));
      const double e = distance - s.radius;
      const double robust = 1 / (1 + e * e / (kRobust * kRobust));
      n.add({-dLateral / distance, -dDepth / distance, -1}, e,
            robust / (kRangeSigma * kRangeSigma));
      *residualSum += robust * e * e;
      *weightSum += robust;
    }
  }

  void addEdges(const Slice& slice, const State& s, Normal& n) const {
    const double half = 0.5 * (m_columnAngle - kFootprint);
    const double sigma =
        std::max(0.004, s.depth * std::hypot(m_columnAngle / std::sqrt(12.0), 0.4 * kFootprint));
    const double weight = 1 / (sigma * sigma);
    if (slice.left == Side::free)
      n.add({1, 0, 1}, s.lateral + s.radius - s.depth * (offset(slice.azimuthEnd) + half), weight);
    if (slice.right == Side::free)
      n.add({1, 0, -1}, s.lateral - s.radius - s.depth * (offset(slice.azimuthBegin) - half),
            weight);
  }

  const ScanLines& m_lines;
  const std::vector<Slice>& m_slices;
  const std::vector<std::uint32_t>& m_used;
  double m_columnAngle, m_bearing;
};

}  // namespace

std::optional<PoleFit> fitPole(const ScanLines& lines, const std::vector<Slice>& slices,
                               const std::vector<std::uint32_t>& used, float columnAngle) {
  if (used.empty()) return std::nullopt;
  const CylinderProblem problem(lines, slices, used, columnAngle);
  State s = problem.initial();
  double residualSum = 0, weightSum = 0;
  Eigen::Matrix3d H;
  for (int i = 0; i < kIterations; ++i) {
    residualSum = weightSum = 0;
    const Normal n = problem.normal(s, &residualSum, &weightSum);
    H = n.H;
    const Eigen::Vector3d step = H.ldlt().solve(n.g);
    if (!step.allFinite()) return std::nullopt;
    s.lateral -= step[0];
    s.depth -= step[1];
    s.radius = std::clamp(s.radius - step[2], 0.005, 1.0);
    if (step.cwiseAbs().maxCoeff() < 1e-5) break;
  }
  PoleFit fit;
  const double c = std::cos(problem.bearing()), sn = std::sin(problem.bearing());
  fit.x = static_cast<float>(s.depth * c - s.lateral * sn);
  fit.y = static_cast<float>(s.depth * sn + s.lateral * c);
  fit.radius = static_cast<float>(s.radius);
  fit.residual = static_cast<float>(std::sqrt(residualSum / std::max(1e-9, weightSum)));
  Eigen::Matrix2d turn;
  turn << -sn, c, c, sn;  // columns: lateral and depth axes in the lidar frame
  const Eigen::Matrix2d local =
      H.inverse().topLeftCorner<2, 2>() + kFloorSigma * kFloorSigma * Eigen::Matrix2d::Identity();
  fit.covariance = turn * local * turn.transpose();
  return fit;
}

}  // namespace polemcl
