#include "core/sensor/PointOrder.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

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
  explicit Sweep(std::size_t points) : m_blockSize(std::max<std::size_t>(1, points / kBlocks)) {}

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
    ++steps;
    m_block.push_back(turned + m_jumped);
    if (m_block.size() == m_blockSize) endBlock();
  }

  /// How far the LiDAR has turned to this side, also where returns are missing, rad.
  double swept(Turn turn) const { return turn == Turn::clockwise ? m_right : m_left; }

 private:
  /// Points are judged in blocks, by their median: some recorders write a firing at a wrong
  /// azimuth.
  static constexpr std::size_t kBlocks = 500;
  std::size_t m_blockSize;
  std::vector<double> m_block;  ///< azimuths since the begin, rad
  double m_before = 0;
  double m_jumped = 0;  ///< by all jumps so far, rad
  std::size_t m_blocks = 0;
  double m_first = 0;              ///< median of the first block, rad
  double m_left = 0, m_right = 0;  ///< farthest of the blocks from the first, rad

  void endBlock() {
    const auto middle = m_block.begin() + static_cast<std::ptrdiff_t>(m_block.size() / 2);
    std::nth_element(m_block.begin(), middle, m_block.end());
    if (m_blocks++ == 0) m_first = *middle;
    m_left = std::max(m_left, *middle - m_first);
    m_right = std::max(m_right, m_first - *middle);
    m_block.clear();
  }
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

OneTurn oneTurn(const PointsView& points, const PointOrder& order, double stamp) {
  if (order.sweep <= kMoreThanATurn) return {points, order.begin};
  const double from = stamp * (order.sweep - 2 * M_PI);
  std::size_t begin = 0, end = 0;
  Sweep sweep(points.size);
  for (std::size_t i = 0; i < points.size; ++i) {
    sweep.add(points.x[i], points.y[i]);
    const double swept = sweep.swept(order.turn);
    if (swept < from) begin = i + 1;
    if (swept <= from + 2 * M_PI) end = i + 1;
  }
  return {{points.x + begin, points.y + begin, points.z + begin, end - begin},
          wrapAngle(order.turn == Turn::clockwise ? order.begin - from : order.begin + from)};
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
