#include "core/sensor/PointOrder.h"

#include <algorithm>
#include <cmath>

namespace polemcl {
namespace {

constexpr double kNearestPoint = 1;               // m; nearer ones may be the vehicle
constexpr double kLongestStep = 20 * M_PI / 180;  // lasers of one firing look to different sides
constexpr double kMostJumps = 0.1;                // share of the steps that are longer
constexpr double kLeastArc = 90 * M_PI / 180, kMostArc = 420 * M_PI / 180;  // of a turn

/// The azimuths of successive points, followed round the sensor.
class Sweep {
 public:
  std::size_t steps = 0, jumps = 0;
  double begin = 0, turned = 0;  ///< rad

  /// \param points In all.
  explicit Sweep(std::size_t points) : m_firstSteps(points / kFirstShare) {}

  void add(double x, double y) {
    if (!(std::hypot(x, y) > kNearestPoint)) return;  // also those that are no numbers
    const double azimuth = std::atan2(y, x);
    if (steps == 0) begin = azimuth;
    const double step = steps == 0 ? 0 : std::remainder(azimuth - m_before, 2 * M_PI);
    m_before = azimuth;
    if (std::abs(step) < kLongestStep) {
      turned += step;
    } else {
      ++jumps;
      m_jumped = std::remainder(azimuth - begin - turned, 2 * M_PI);
    }
    const double gone = turned + m_jumped;
    m_left = std::max(m_left, gone);
    m_right = std::max(m_right, -gone);
    if (steps++ > m_firstSteps) return;
    m_firstLeft = m_left;
    m_firstRight = m_right;
  }

  /// How far the foremost laser has gone, also where returns are missing, rad.
  double swept(Turn turn) const {
    return turn == Turn::clockwise ? m_right - m_firstRight : m_left - m_firstLeft;
  }

 private:
  /// The first firings are the first 1/500 of the points.
  static constexpr std::size_t kFirstShare = 500;
  std::size_t m_firstSteps;
  double m_before = 0;
  double m_jumped = 0;                                                ///< by all jumps so far, rad
  double m_left = 0, m_right = 0, m_firstLeft = 0, m_firstRight = 0;  ///< farthest, rad
};

}  // namespace

std::optional<PointOrder> pointOrder(const PointsView& points) {
  Sweep sweep(points.size);
  for (std::size_t i = 0; i < points.size; ++i) sweep.add(points.x[i], points.y[i]);
  const double arc = std::abs(sweep.turned);
  if (arc < kLeastArc || arc > kMostArc ||
      static_cast<double>(sweep.jumps) > kMostJumps * static_cast<double>(sweep.steps))
    return std::nullopt;
  const Turn turn = sweep.turned > 0 ? Turn::counterclockwise : Turn::clockwise;
  return PointOrder{turn, sweep.begin, arc, sweep.swept(turn)};
}

PointsView oneTurn(const PointsView& points, const PointOrder& order, double stamp) {
  if (order.sweep <= kMoreThanATurn) return points;
  const double from = stamp * (order.sweep - 2 * M_PI);
  std::size_t begin = 0, end = 0;
  Sweep sweep(points.size);
  for (std::size_t i = 0; i < points.size; ++i) {
    sweep.add(points.x[i], points.y[i]);
    const double swept = sweep.swept(order.turn);
    if (swept < from) begin = i + 1;
    if (swept <= from + 2 * M_PI) end = i + 1;
  }
  return {points.x + begin, points.y + begin, points.z + begin, end - begin};
}

bool PointOrder::isWhole() const {
  constexpr double kNearlyAll = 300 * M_PI / 180;
  return arc >= kNearlyAll;
}

double beginArc(const std::vector<PointOrder>& orders) {
  double least = 0, most = 0;
  for (const PointOrder& order : orders) {
    if (order.turn != orders.front().turn) return 0;
    const double away = std::remainder(order.begin - orders.front().begin, 2 * M_PI);
    least = std::min(least, away);
    most = std::max(most, away);
  }
  return most - least;
}

}  // namespace polemcl
