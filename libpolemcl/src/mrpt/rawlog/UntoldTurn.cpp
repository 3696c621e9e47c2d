#include "mrpt/rawlog/UntoldTurn.h"

#include "core/common/Angles.h"
#include "mrpt/observation/ObservationPoints.h"

namespace polemcl {
namespace {

bool hasSetCut(const ScanTiming& set) {
  return set.known() && !set.movingCut;
}

}  // namespace

bool UntoldTurnSearch::wants(std::size_t ordinal) {
  return ordinal > 0 && (ordinal & (ordinal - 1)) == 0;  // a power of two
}

void UntoldTurnSearch::add(const std::optional<PointOrder>& order) {
  if (!order)
    m_isOther = true;
  else if (order->isWhole())
    m_orders.push_back(*order);
}

std::optional<UntoldTurn> UntoldTurnSearch::found(const ScanTiming& set) const {
  constexpr std::size_t kFewest = 3;
  // Where returns are missing, whole turns seem to begin up to 60 degrees later.
  constexpr double kAgainstSetCut = 70 * degree;
  if (m_isOther || m_orders.size() < kFewest) return std::nullopt;
  const double arc = beginArc(m_orders);
  if (arc <= (hasSetCut(set) ? kAgainstSetCut : kMovingBegin)) return std::nullopt;
  return UntoldTurn{m_orders.front().turn, arc, hasSetCut(set)};
}

std::optional<PointOrder> untoldOrder(const mrpt::obs::CObservation& scan,
                                      const SensorOptions& sensor, const ScanTiming& recorded) {
  const ScanTiming& set = sensor.timing;
  const bool isUntold = set.turn == Turn::automatic && recorded.turn == Turn::automatic;
  if (!isUntold && !hasSetCut(set)) return std::nullopt;
  ObservationPoints points(sensor);
  const ObservationPoints::Loan loan(points);
  const PointsView cloud = points.read(scan);
  if (points.timing() || points.camera()) return std::nullopt;
  return pointOrder(cloud);
}

}  // namespace polemcl
