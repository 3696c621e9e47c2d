#include "core/extraction/scan_line/PoleFitting.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace polemcl {
namespace {

constexpr double kRangeSigma = 0.025;  ///< m: noise of one range, and of the surface's roughness
constexpr double kRobust = 0.06;  ///< m: Cauchy scale of range residuals; mixed pixels lie beyond
constexpr double kFootprint = 0.0008;  ///< rad: a beam's width widens what it sees by this
constexpr double kDivergence = 0.002;  ///< rad: full width of a beam
constexpr double kGrazing =
    0.85;  ///< share of the radius beyond which the front's slope is not used
constexpr double kRadiusPrior = 0.12;  ///< m: posts and trunks of streets
constexpr double kRadiusPriorSigma = 0.10;
constexpr double kFloorSigma =
    0.010;  ///< m: what no number of returns averages out (laser biases, shape)
constexpr int kIterations = 6;
constexpr double kThinnestBoard = 0.12;  ///< m: half its width
constexpr double kFlatter = 0.8;         ///< a board's residuals against a cylinder's, at most
constexpr double kPostRadius = 0.04;     ///< m: of a sign's post
constexpr std::size_t kMostSegments = 128;
constexpr std::uint32_t kGroups = 12;  ///< of neighbouring returns, in a segment that has more

struct State {
  double lateral = 0, depth = 0, radius = kRadiusPrior;
};

/// Normal equations of the cylinder in (lateral, depth, radius), seen along a reference bearing.
struct Normal {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();  ///< lower triangle
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
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
  /// The same where the depth does not matter, and the others count by 1 or -1.
  void addEdge(double side, double residual, double weight) {
    H(0, 0) += weight;
    H(2, 0) += weight * side;
    H(2, 2) += weight;
    g[0] += weight * residual;
    g[2] += weight * side * residual;
  }
};

/// Returns, or means of neighbouring ones, against the reference bearing: a structure of arrays.
struct FitPoints {
  std::size_t count = 0;
  float along[kMostSegments * kGroups], across[kMostSegments * kGroups];  ///< m
  float returns[kMostSegments * kGroups];
};
struct Residuals {
  float residual[kMostSegments * kGroups], slope[kMostSegments * kGroups],
      front[kMostSegments * kGroups], weight[kMostSegments * kGroups];
};

/// Weight of a segment, 0 to 1: grass and kerbs mix with a pole's foot, and whether a beam there is
/// taken for ground should not matter.
float firmness(const ScanLineSegment& segment, float firmHeight) {
  constexpr float kFoot = 0.5f, kLeast = 0.02f;
  return std::clamp(1 - (firmHeight - segment.z) / kFoot, kLeast, 1.f);
}

class CylinderProblem {
 public:
  CylinderProblem(const ScanLines& lines, const std::vector<ScanLineSegment>& segments,
                  const std::vector<std::uint32_t>& used, const PoleView& view, double height)
      : m_lines(lines),
        m_segments(segments),
        m_used(used),
        // More than these add nothing to what the radius prior and the floor leave.
        m_stride((used.size() + kMostSegments - 1) / kMostSegments),
        m_firmHeight(view.firmHeight),
        m_columnAngle(view.columnAngle),
        m_edgeSigma(
            std::sqrt(m_columnAngle * m_columnAngle / 12 + 0.16 * kFootprint * kFootprint)) {
    const ScanLineSegment& reference = segments[used[used.size() / 2]];
    m_bearing = 0.5 * (reference.azimuthBegin + reference.azimuthEnd);
    m_cos = std::cos(m_bearing);
    m_sin = std::sin(m_bearing);
    m_height = height;
    m_leanAlong = view.uprightX * m_cos + view.uprightY * m_sin;
    m_leanAcross = view.uprightY * m_cos - view.uprightX * m_sin;
    for (std::size_t i = 0; i < m_used.size(); i += m_stride) gather(m_segments[m_used[i]]);
  }
  /// Replaces the cylinder by a thin one right behind when the returns lie on a plane across: a
  /// sign before its post.
  void considerBoard(State& s) const {
    if (s.radius < kThinnestBoard) return;
    double sum = 0, n = 0;
    for (std::size_t k = 0; k < m_points.count; ++k) {
      sum += m_points.along[k] * m_points.returns[k];
      n += m_points.returns[k];
    }
    const double plane = sum / n;
    double flat = 0, round = 0;
    Residuals r;
    evaluate(m_points, s, r);
    for (std::size_t k = 0; k < m_points.count; ++k) {
      const double across = m_points.along[k] - plane;
      flat += m_points.returns[k] * across * across;
      round += m_points.returns[k] * r.residual[k] * r.residual[k];
    }
    if (flat > kFlatter * kFlatter * round) return;
    s.depth = plane + kPostRadius;
    s.radius = kPostRadius;
  }

  double cosine() const { return m_cos; }
  double sine() const { return m_sin; }

  State initial() const {
    State s;
    double sumLateral = 0, sumDepth = 0, sumWidth = 0;
    for (std::uint32_t u : m_used) {
      const ScanLineSegment& segment = m_segments[u];
      const Shift lean = leanOf(segment);
      sumLateral +=
          segment.rho * offset(0.5 * (segment.azimuthBegin + segment.azimuthEnd)) - lean.across;
      sumDepth += segment.rho - lean.along;
      sumWidth +=
          segment.rho * (segment.azimuthEnd - segment.azimuthBegin + m_columnAngle - kFootprint);
    }
    const double n = static_cast<double>(m_used.size());
    s.radius = std::clamp(0.5 * sumWidth / n, 0.02, 0.5);
    s.lateral = sumLateral / n;
    s.depth = sumDepth / n + s.radius;
    return s;
  }

  /// \param r Becomes the residuals in this state.
  Normal normal(const State& s, Residuals& r) const {
    Normal n;
    n.add(0, 0, 1, s.radius - kRadiusPrior, 1 / (kRadiusPriorSigma * kRadiusPriorSigma));
    evaluate(m_points, s, r);
    addRanges(r, n);
    const double sigma = std::max(0.004, s.depth * m_edgeSigma);
    for (std::size_t i = 0; i < m_used.size(); i += m_stride)
      addEdges(m_segments[m_used[i]], s, sigma * sigma, n);
    return n;
  }

  /// Robust standard deviation of the ranges.
  double deviation(const Residuals& r) const {
    double residualSum = 0, weightSum = 0;
    for (std::size_t k = 0; k < m_points.count; ++k) {
      residualSum += r.weight[k] * r.residual[k] * r.residual[k];
      weightSum += r.weight[k];
    }
    return std::sqrt(residualSum / std::max(1e-9, weightSum));
  }

 private:
  struct Shift {
    double along, across;  ///< m
  };
  /// How far an upright pole is at a segment from where it is at the height of the fit.
  Shift leanOf(const ScanLineSegment& segment) const {
    const double up = segment.z - m_height;
    return {m_leanAlong * up, m_leanAcross * up};
  }

  /// Azimuth against the reference bearing; a segment's azimuths differ from it by less than a turn
  /// and a half.
  double offset(double azimuth) const {
    const double d = azimuth - m_bearing;
    return d > M_PI ? d - 2 * M_PI : d < -M_PI ? d + 2 * M_PI : d;
  }

  void addRanges(const Residuals& r, Normal& n) const {
    constexpr double kWeight = 1 / (kRangeSigma * kRangeSigma);
    for (std::size_t k = 0; k < m_points.count; ++k)
      n.add(r.slope[k], 1, -r.front[k], r.residual[k], r.weight[k] * kWeight);
  }

  /// Takes up the returns of a segment.
  void gather(const ScanLineSegment& segment) {
    const Return* row = m_lines.begin(segment.row);
    const std::size_t size = m_lines.size(segment.row);
    const std::uint32_t groups = std::min(segment.count, kGroups);
    const Shift lean = leanOf(segment);
    for (std::uint32_t g = 0, first = 0, end; g < groups; ++g, first = end) {
      end = (g + 1) * segment.count / groups;
      float along = 0, across = 0;
      for (std::uint32_t k = first; k < end; ++k) {
        const std::uint32_t i = segment.first + k;
        const Return& r = row[i < size ? i : i - size];
        // Sine and cosine to 1e-7 for half a radian; of all poles but those at arm's length.
        const float d = static_cast<float>(offset(r.azimuth)), q = d * d;
        along += r.rho * (1 - q * (1 / 2.f - q * (1 / 24.f - q * (1 / 720.f))));
        across += r.rho * d * (1 - q * (1 / 6.f - q * (1 / 120.f - q * (1 / 5040.f))));
      }
      const float returns = static_cast<float>(end - first);
      m_points.along[m_points.count] = along / returns - static_cast<float>(lean.along);
      m_points.across[m_points.count] = across / returns - static_cast<float>(lean.across);
      m_points.returns[m_points.count++] = returns * firmness(segment, m_firmHeight);
    }
  }

  static void evaluate(const FitPoints& points, const State& s, Residuals& r) {
    const float lateral = static_cast<float>(s.lateral), depth = static_cast<float>(s.depth);
    const float radius = static_cast<float>(s.radius), perRadius = 1 / radius;
    const float half = static_cast<float>(0.5 * kDivergence) * depth;
    constexpr float kGraze = static_cast<float>(kGrazing);
    constexpr float kPerScale = static_cast<float>(1 / (kRobust * kRobust));
    for (std::size_t k = 0; k < points.count; ++k) {
      // A beam that grazes the edge hits it with the inner part of its footprint only: where the
      // return comes from is the middle of what footprint and cylinder share.
      const float across = points.across[k] - lateral;
      const float inner = std::min(std::max(across - half, -radius), radius);
      const float outer = std::min(std::max(across + half, -radius), radius);
      const float hit = 0.5f * (inner + outer) * perRadius;
      const float u = std::min(std::max(hit, -kGraze), kGraze);
      const float front = std::sqrt(1 - u * u);
      const float e = depth - radius * front - points.along[k];
      r.residual[k] = e;
      r.slope[k] = -u / front;
      r.front[k] = front;
      r.weight[k] = points.returns[k] / (1 + e * e * kPerScale);
    }
  }

  void addEdges(const ScanLineSegment& segment, const State& s, double variance, Normal& n) const {
    const double half = 0.5 * (m_columnAngle - kFootprint);
    const double weight = firmness(segment, m_firmHeight) / variance;
    const Shift lean = leanOf(segment);
    const double lateral = s.lateral + lean.across, depth = s.depth + lean.along;
    if (segment.left == Side::free)
      n.addEdge(1, lateral + s.radius - depth * (offset(segment.azimuthEnd) + half), weight);
    if (segment.right == Side::free)
      n.addEdge(-1, lateral - s.radius - depth * (offset(segment.azimuthBegin) - half), weight);
  }

  const ScanLines& m_lines;
  const std::vector<ScanLineSegment>& m_segments;
  const std::vector<std::uint32_t>& m_used;
  std::size_t m_stride;  ///< of the segments used
  FitPoints m_points;
  float m_firmHeight;
  double m_columnAngle;
  double m_edgeSigma;  ///< of the bearing of an edge, rad
  double m_bearing, m_cos, m_sin;
  double m_height;                   ///< of the fit, lidar frame, m
  double m_leanAlong, m_leanAcross;  ///< of an upright pole, m per m of height
};

}  // namespace

PoleAxis roughAxis(const std::vector<ScanLineSegment>& segments,
                   const std::vector<std::uint32_t>& used, float columnAngle,
                   const Eigen::Vector2f& upright) {
  float x = 0, y = 0, z = 0, width = 0, n = 0;
  for (std::uint32_t u : used) {
    const ScanLineSegment& segment = segments[u];
    x += segment.x;
    y += segment.y;
    z += segment.z;
    width += segment.rho * (segment.azimuthEnd - segment.azimuthBegin + columnAngle -
                            static_cast<float>(kFootprint));
    n += 1;
  }
  PoleAxis axis;
  axis.radius = std::clamp(0.5f * width / n, 0.02f, 0.5f);
  const float rho = std::sqrt(x * x + y * y) / n;
  axis.x = x / n * (1 + axis.radius / rho);
  axis.y = y / n * (1 + axis.radius / rho);
  axis.z = z / n;
  axis.upright = upright;
  return axis;
}

namespace {

/// How a pole's place changes with height, from the fronts of its segments; shrunk towards upright.
struct AxisTilt {
  double x = 0, y = 0;  ///< m per m of height
  double height = 0;    ///< mean of the segments, m
  double prior = 1;     ///< share of the prior in x and y
  double low = 0, high = 0;
};

AxisTilt tiltOf(const std::vector<ScanLineSegment>& segments,
                const std::vector<std::uint32_t>& used, const PoleView& view) {
  // Poles are upright but for the sway of the sensor. The prior is the ratio of the variances of a
  // front's place and of the tilt.
  constexpr double kPrior = 4;
  AxisTilt tilt;
  double n = 0, mx = 0, my = 0;
  for (std::uint32_t u : used) {
    const double w = firmness(segments[u], view.firmHeight);
    n += w;
    mx += w * segments[u].x;
    my += w * segments[u].y;
    tilt.height += w * segments[u].z;
  }
  mx /= n;
  my /= n;
  tilt.height /= n;
  double zz = 0;
  for (std::uint32_t u : used) {
    const double z = segments[u].z - tilt.height, w = firmness(segments[u], view.firmHeight);
    zz += w * z * z;
    tilt.x += w * z * (segments[u].x - mx);
    tilt.y += w * z * (segments[u].y - my);
  }
  tilt.x = (tilt.x + kPrior * view.uprightX) / (zz + kPrior);
  tilt.y = (tilt.y + kPrior * view.uprightY) / (zz + kPrior);
  tilt.prior = kPrior / (zz + kPrior);
  tilt.high = segments[used.front()].z;
  tilt.low = segments[used.back()].z;
  return tilt;
}

/// Moves the fit along the pole to the height of the sensor, as far as the segments reach: there a
/// roll or pitch of the sensor does not move it.
void moveToSensorHeight(const AxisTilt& tilt, PoleFit& fit) {
  const auto [low, high] = std::minmax(tilt.low, tilt.high);
  const double reached = std::clamp(0.0, low, high);
  const double step = reached - tilt.height;
  fit.x += static_cast<float>(tilt.x * step);
  fit.y += static_cast<float>(tilt.y * step);
  fit.covariance +=
      Eigen::Matrix2d::Identity() * (tiltSigma * tiltSigma * tilt.prior * step * step);
  fit.tilt.tilt = {static_cast<float>(tilt.x), static_cast<float>(tilt.y)};
  fit.tilt.prior = static_cast<float>(tilt.prior);
  fit.tilt.step = static_cast<float>(step);
  fit.tilt.gap = static_cast<float>(-reached);
}

}  // namespace

std::optional<PoleFit> fitPole(const ScanLines& lines, const std::vector<ScanLineSegment>& segments,
                               const std::vector<std::uint32_t>& used, const PoleView& view) {
  if (used.empty()) return std::nullopt;
  const AxisTilt tilt = tiltOf(segments, used, view);
  const CylinderProblem problem(lines, segments, used, view, tilt.height);
  State s = problem.initial();
  Normal n;
  Residuals residuals;
  for (int i = 0; i < kIterations; ++i) {
    n = problem.normal(s, residuals);
    n.H.triangularView<Eigen::StrictlyUpper>() = n.H.transpose();
    const Eigen::Vector3d step = n.H.inverse() * n.g;
    if (!step.allFinite()) return std::nullopt;
    s.lateral -= step[0];
    s.depth -= step[1];
    s.radius = std::clamp(s.radius - step[2], 0.005, 1.0);
    if (step.cwiseAbs().maxCoeff() < 1e-3) break;  // what is left is its square
  }
  problem.considerBoard(s);
  PoleFit fit;
  const double c = problem.cosine(), sn = problem.sine();
  fit.x = static_cast<float>(s.depth * c - s.lateral * sn);
  fit.y = static_cast<float>(s.depth * sn + s.lateral * c);
  fit.radius = static_cast<float>(s.radius);
  fit.residual = static_cast<float>(problem.deviation(residuals));
  Eigen::Matrix2d turn;
  turn << -sn, c, c, sn;  // columns: lateral and depth axes in the lidar frame
  const Eigen::Matrix2d local =
      n.H.inverse().topLeftCorner<2, 2>() + kFloorSigma * kFloorSigma * Eigen::Matrix2d::Identity();
  fit.covariance = turn * local * turn.transpose();
  moveToSensorHeight(tilt, fit);
  return fit;
}

}  // namespace polemcl
