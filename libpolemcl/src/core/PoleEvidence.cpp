#include <polemcl/core/PoleEvidence.h>

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

/// The candidate's place, and questions to single rows about it.
class Place {
 public:
  Place(const ScanLines& lines, const SensorModel& sensor, const PoleFit& fit)
      : m_lines(lines),
        m_fit(fit),
        m_rho(std::hypot(fit.x, fit.y)),
        m_bearing(std::atan2(fit.y, fit.x)),
        m_column(static_cast<float>(sensor.columnAngle())) {}
  float rho() const { return m_rho; }
  float bearing() const { return m_bearing; }

  /// Calls f(return, distance to the axis) for the returns of a row within `halfWidth` m to either
  /// side.
  template <class F>
  void around(int row, float halfWidth, F f) const {
    const float half = std::min(1.f, halfWidth / std::max(m_rho, 0.5f));
    const float pi = static_cast<float>(M_PI);
    visit(row, std::max(m_bearing - half, -pi), std::min(m_bearing + half, pi), f);
    if (m_bearing - half < -pi) visit(row, m_bearing - half + 2 * pi, pi, f);
    if (m_bearing + half > pi) visit(row, -pi, m_bearing + half - 2 * pi, f);
  }

  Meeting meet(int row, float* z) const {
    Meeting meeting = Meeting::empty;
    around(row, std::max(m_fit.radius, 0.7f * m_column * m_rho),
           [&](const Return& r, float distance) {
             if (distance < m_fit.radius + kNear) {
               *z = r.z;
               meeting = Meeting::near;
             } else if (meeting != Meeting::near && r.rho < m_rho) {
               meeting = Meeting::occluded;
             } else if (meeting == Meeting::empty) {
               meeting = Meeting::passed;
             }
           });
    return meeting;
  }

  bool cluttered(int row) const {
    int found = 0;
    around(row, m_fit.radius + kRingOuter, [&](const Return&, float distance) {
      found += distance > m_fit.radius + kRingInner && distance < m_fit.radius + kRingOuter;
    });
    return found > 0;
  }

 private:
  template <class F>
  void visit(int row, float from, float to, F f) const {
    const Return* end = m_lines.end(row);
    for (const Return* r = m_lines.begin(row) + m_lines.lowerBound(row, from);
         r < end && r->azimuth <= to; ++r) {
      const float dx = r->rho * std::cos(r->azimuth) - m_fit.x;
      const float dy = r->rho * std::sin(r->azimuth) - m_fit.y;
      f(*r, std::sqrt(dx * dx + dy * dy));
    }
  }
  const ScanLines& m_lines;
  const PoleFit& m_fit;
  float m_rho, m_bearing, m_column;
};

/// Straight line through the slices' middles: scatter and tilt.
void line(const std::vector<Slice>& slices, const Stack& stack, PoleEvidence& evidence) {
  const float n = static_cast<float>(stack.slices.size());
  float mz = 0, mx = 0, my = 0, zz = 0, zx = 0, zy = 0;
  for (auto i : stack.slices) mz += slices[i].z / n, mx += slices[i].x / n, my += slices[i].y / n;
  for (auto i : stack.slices) {
    const float z = slices[i].z - mz;
    zz += z * z;
    zx += z * (slices[i].x - mx);
    zy += z * (slices[i].y - my);
  }
  const float ax = zz > 0 ? zx / zz : 0, ay = zz > 0 ? zy / zz : 0;
  float sum = 0;
  for (auto i : stack.slices) {
    const float z = slices[i].z - mz;
    const float ex = slices[i].x - mx - ax * z, ey = slices[i].y - my - ay * z;
    sum += ex * ex + ey * ey;
  }
  // Two parameters were fitted per axis: with two slices nothing is left to judge by.
  evidence.scatter = n > 2 ? std::sqrt(sum / (n - 2)) : 0;
  evidence.tilt = std::atan(std::hypot(ax, ay));
}

void widths(const std::vector<Slice>& slices, const Stack& stack, PoleEvidence& evidence) {
  float sum = 0, squares = 0, n = 0;
  for (auto i : stack.slices) {
    const float width = slices[i].rho * (slices[i].azimuthEnd - slices[i].azimuthBegin);
    sum += width;
    squares += width * width;
    n += 1;
  }
  evidence.widthSpread = std::sqrt(std::max(0.f, squares / n - sum / n * sum / n));
}

/// Walks up from the topmost slice while something stands there; one silent row may interrupt it.
void top(const Place& place, const SensorModel& sensor, int row, float ground,
         PoleEvidence& evidence) {
  evidence.topBound = kInfinity;
  float bound = kInfinity;
  for (int misses = 0, r = row - 1; r >= 0 && misses < 2; --r) {
    float z = 0;
    const Meeting meeting = place.meet(r, &z);
    if (meeting == Meeting::near) {
      evidence.top = std::max(evidence.top, z - ground);
      misses = 0;
      bound = kInfinity;
    } else if (meeting == Meeting::occluded) {
      return;
    } else {
      const Beam& beam = sensor.beam(r);
      if (misses++ == 0)
        bound =
            place.rho() * static_cast<float>(beam.slope) + static_cast<float>(beam.offset) - ground;
    }
  }
  evidence.topBound = bound;
}

}  // namespace

PoleEvidence gatherEvidence(const ScanLines& lines, const SensorModel& sensor,
                            const GroundGrid& ground, const std::vector<Slice>& slices,
                            const Stack& stack, const PoleFit& fit) {
  const Place place(lines, sensor, fit);
  const float groundZ = ground.at(place.bearing(), place.rho());
  PoleEvidence e;
  e.slices = static_cast<int>(stack.slices.size());
  float low = kInfinity, high = -kInfinity;
  int expected = slices[stack.slices.front()].row;
  for (auto i : stack.slices) {
    const Slice& slice = slices[i];
    e.points += static_cast<int>(slice.count);
    e.wholeSlices += slice.whole();
    low = std::min(low, slice.z);
    high = std::max(high, slice.z);
    for (; expected < slice.row; ++expected) {
      float z = 0;
      const Meeting meeting = place.meet(expected, &z);
      e.rowsPassed += meeting == Meeting::passed || meeting == Meeting::empty;
      e.rowsWide += meeting == Meeting::near;
    }
    expected = slice.row + 1;
    e.rowsCluttered += place.cluttered(slice.row);
  }
  e.slimHeight = high - low;
  e.bottom = low - groundZ;
  e.top = high - groundZ;
  top(place, sensor, slices[stack.slices.front()].row, groundZ, e);
  line(slices, stack, e);
  widths(slices, stack, e);
  return e;
}

}  // namespace polemcl
