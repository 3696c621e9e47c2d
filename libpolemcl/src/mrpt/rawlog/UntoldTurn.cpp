#include "mrpt/rawlog/UntoldTurn.h"

#include "mrpt/observation/ObservationPoints.h"

namespace polemcl {

bool UntoldTurnSearch::wants(std::size_t ordinal) {
  return ordinal > 0 && (ordinal & (ordinal - 1)) == 0;  // a power of two
}

void UntoldTurnSearch::add(const std::optional<PointOrder>& order) {
  if (!order)
    m_isOther = true;
  else if (order->isWhole())
    m_orders.push_back(*order);
}

std::optional<UntoldTurn> UntoldTurnSearch::found() const {
  constexpr std::size_t kFewest = 3;
  if (m_isOther || m_orders.size() < kFewest) return std::nullopt;
  const double arc = beginArc(m_orders);
  if (arc <= kMovingBegin) return std::nullopt;
  return UntoldTurn{m_orders.front().turn, arc};
}

std::optional<PointOrder> untoldOrder(const mrpt::obs::CObservation& scan,
                                      const SensorOptions& sensor, const ScanTiming& recorded) {
  if (sensor.timing.turn != Turn::automatic || recorded.turn != Turn::automatic)
    return std::nullopt;
  ObservationPoints points(sensor);
  const ObservationPoints::Loan loan(points);
  const PointsView cloud = points.read(scan);
  if (points.timing() || points.camera()) return std::nullopt;
  return pointOrder(cloud);
}

}  // namespace polemcl
