#include "core/extraction/scan_line/CandidateFeatures.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace polemcl {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNear =
    0.35f;  ///< m: what stands this near (outside the radius) belongs to the thing
constexpr float kRingInner = 0.15f;  ///< m outside the radius: mixed pixels end here
constexpr float kRingOuter = 0.55f;  ///< m outside the radius

/// What one beam meets at a candidate's place.
enum class Meeting {
  near,      ///< a return at the place
  passed,    ///< a return from behind: the beam went through
  empty,     ///< no return at all
  occluded,  ///< a return from before it
};

/// The candidate's place, and questions to single rows about it.
class Place {
 public:
  Place(const ScanLines& lines, const SensorModel& sensor, const PoleAxis& axis)
      : m_lines(lines),
        m_sensor(sensor),
        m_axis(axis),
        m_leans(axis.upright != Eigen::Vector2f::Zero()),
        m_spot(spot(axis.x, axis.y)),
        m_column(static_cast<float>(sensor.columnAngle())) {}
  float heightOfRow(int row) const {
    return m_sensor.heightOver(row, m_axis.x, m_axis.y, m_spot.rho);
  }

  Meeting meet(int row, float* z) const {
    Meeting meeting = Meeting::empty;
    const float reach = m_axis.radius + kNear;
    const Spot at = spotOf(row);
    around(row, at, std::max(m_axis.radius, 0.7f * m_column * at.rho), [&](const Return& r) {
      if (squaredDistance(r, at) < reach * reach) {
        *z = r.z;
        meeting = Meeting::near;
      } else if (meeting != Meeting::near && r.rho < at.rho) {
        meeting = Meeting::occluded;
      } else if (meeting == Meeting::empty) {
        meeting = Meeting::passed;
      }
    });
    return meeting;
  }

  /// True when a row has returns in the ring around the place.
  bool cluttered(int row) const {
    int found = 0;
    const float inner = m_axis.radius + kRingInner, outer = m_axis.radius + kRingOuter;
    const Spot at = spotOf(row);
    around(row, at, outer, [&](const Return& r) {
      const float d = squaredDistance(r, at);
      found |= static_cast<int>(d > inner * inner) & static_cast<int>(d < outer * outer);
    });
    return found != 0;
  }

 private:
  struct Spot {
    float rho, bearing;
  };
  static Spot spot(float x, float y) { return {std::sqrt(x * x + y * y), std::atan2(y, x)}; }

  /// Where a row meets the axis of an upright pole.
  Spot spotOf(int row) const {
    if (!m_leans) return m_spot;
    const float up = heightOfRow(row) - m_axis.z;
    return spot(m_axis.x + m_axis.upright.x() * up, m_axis.y + m_axis.upright.y() * up);
  }

  /// Squared distance of a return from the axis, m², by the law of cosines; the angle between is
  /// small.
  static float squaredDistance(const Return& r, const Spot& at) {
    const float step = r.rho - at.rho, turn = wrapped(r.azimuth - at.bearing);
    return step * step + r.rho * at.rho * turn * turn * (1 - turn * turn * (1 / 12.f));
  }

  static float wrapped(float turn) {
    constexpr float kPi = static_cast<float>(M_PI);
    return turn > kPi ? turn - 2 * kPi : turn < -kPi ? turn + 2 * kPi : turn;
  }

  /// Calls f(return) for the returns of a row within `halfWidth` m to either side.
  template <class F>
  void around(int row, const Spot& at, float halfWidth, F f) const {
    const float half = std::min(1.f, halfWidth / std::max(at.rho, 0.5f));
    const float pi = static_cast<float>(M_PI);
    visit(row, std::max(at.bearing - half, -pi), std::min(at.bearing + half, pi), f);
    if (at.bearing - half < -pi) visit(row, at.bearing - half + 2 * pi, pi, f);
    if (at.bearing + half > pi) visit(row, -pi, at.bearing + half - 2 * pi, f);
  }

  template <class F>
  void visit(int row, float from, float to, F f) const {
    const Return* end = m_lines.end(row);
    for (const Return* r = m_lines.begin(row) + m_lines.lowerBound(row, from);
         r < end && r->azimuth <= to; ++r)
      f(*r);
  }

  const ScanLines& m_lines;
  const SensorModel& m_sensor;
  const PoleAxis& m_axis;
  bool m_leans;
  Spot m_spot;  ///< at the height of the axis
  float m_column;
};

/// Walks up from the topmost segment while something stands there; one silent row may interrupt it.
void topFeatures(const Place& place, int row, float ground, CandidateFeatures& features) {
  features.topBound = kInfinity;
  float bound = kInfinity;
  for (int misses = 0, r = row - 1; r >= 0 && misses < 2; --r) {
    float z = 0;
    const Meeting meeting = place.meet(r, &z);
    if (meeting == Meeting::near) {
      features.top = std::max(features.top, z - ground);
      misses = 0;
      bound = kInfinity;
    } else if (meeting == Meeting::occluded) {
      return;
    } else {
      if (misses++ == 0) bound = place.heightOfRow(r) - ground;
    }
  }
  features.topBound = bound;
}

}  // namespace

ClusterShape measureShape(const std::vector<ScanLineSegment>& segments,
                          const SegmentCluster& cluster, const Eigen::Vector2f& upright) {
  ClusterShape shape;
  shape.low = segments[cluster.bottom()].z;
  shape.high = segments[cluster.top()].z;
  const float n = static_cast<float>(cluster.count);
  float mz = 0, mx = 0, my = 0, mw = 0;
  for (auto i : cluster) {
    const ScanLineSegment& segment = segments[i];
    shape.points += static_cast<int>(segment.count);
    shape.wholeSegments += segment.whole();
    mz += segment.z / n;
    mx += segment.x / n;
    my += segment.y / n;
    mw += segment.width() / n;
  }
  float zz = 0, zx = 0, zy = 0, xx = 0, yy = 0, ww = 0;
  for (auto i : cluster) {
    const ScanLineSegment& segment = segments[i];
    const float z = segment.z - mz, x = segment.x - mx, y = segment.y - my,
                w = segment.width() - mw;
    zz += z * z;
    zx += z * x;
    zy += z * y;
    xx += x * x;
    yy += y * y;
    ww += w * w;
  }
  const float ax = zz > 0 ? zx / zz : 0, ay = zz > 0 ? zy / zz : 0;
  // Two parameters were fitted per axis: with two segments nothing is left to judge by.
  const float rest = xx + yy - ax * zx - ay * zy;
  shape.scatter = n > 2 ? std::sqrt(std::max(0.f, rest) / (n - 2)) : 0;
  const float leanX = ax - upright.x(), leanY = ay - upright.y();
  shape.tilt = std::atan(std::sqrt(leanX * leanX + leanY * leanY));
  shape.widthSpread = std::sqrt(ww / n);
  return shape;
}

CandidateFeatures computeFeatures(const ScanLines& lines, const SensorModel& sensor,
                                  const GroundGrid& ground,
                                  const std::vector<ScanLineSegment>& segments,
                                  const SegmentCluster& cluster, const ClusterShape& shape,
                                  const PoleAxis& axis, double minTop) {
  const Place place(lines, sensor, axis);
  const float groundZ = ground.at(axis.x, axis.y);
  CandidateFeatures e;
  e.bottom = shape.low - groundZ;
  e.top = shape.high - groundZ;
  topFeatures(place, segments[cluster.top()].row, groundZ, e);
  if (e.highestTop() < minTop) return e;
  int expected = segments[cluster.top()].row;
  for (auto i : cluster) {
    for (; expected < segments[i].row; ++expected) {
      float z = 0;
      const Meeting meeting = place.meet(expected, &z);
      e.rowsPassed += meeting == Meeting::passed || meeting == Meeting::empty;
      e.rowsWide += meeting == Meeting::near;
    }
    ++expected;
  }
  return e;
}

float clutteredShare(const ScanLines& lines, const SensorModel& sensor,
                     const std::vector<ScanLineSegment>& segments, const SegmentCluster& cluster,
                     const PoleAxis& axis) {
  const Place place(lines, sensor, axis);
  int cluttered = 0;
  for (auto i : cluster) cluttered += place.cluttered(segments[i].row);
  return static_cast<float>(cluttered) / static_cast<float>(cluster.count);
}

}  // namespace polemcl
