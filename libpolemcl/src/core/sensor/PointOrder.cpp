#include "core/sensor/PointOrder.h"

#include <algorithm>
#include <cmath>

namespace polemcl {
namespace {

constexpr double kNearestPoint = 1;               // m; nearer ones may be the vehicle
constexpr double kLongestStep = 20 * M_PI / 180;  // lasers of one firing look to different sides
constexpr double kMostJumps = 0.1;                // share of the steps that are longer
constexpr double kLeastArc = 90 * M_PI / 180, kMostArc = 420 * M_PI / 180;  // of a turn

}  // namespace

std::optional<PointOrder> pointOrder(const PointsView& points) {
  PointOrder order;
  std::size_t steps = 0, jumps = 0;
  double turned = 0, before = 0;
  for (std::size_t i = 0; i < points.size; ++i) {
    const double x = points.x[i], y = points.y[i];
    if (!(std::hypot(x, y) > kNearestPoint)) continue;  // also those that are no numbers
    const double azimuth = std::atan2(y, x);
    if (steps == 0) order.begin = azimuth;
    const double step = steps == 0 ? 0 : std::remainder(azimuth - before, 2 * M_PI);
    before = azimuth;
    ++steps;
    if (std::abs(step) < kLongestStep)
      turned += step;
    else
      ++jumps;
  }
  order.arc = std::abs(turned);
  if (order.arc < kLeastArc || order.arc > kMostArc ||
      static_cast<double>(jumps) > kMostJumps * static_cast<double>(steps))
    return std::nullopt;
  order.turn = turned > 0 ? Turn::counterclockwise : Turn::clockwise;
  return order;
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
