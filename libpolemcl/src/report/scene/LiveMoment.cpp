#include "report/scene/LiveMoment.h"

#include <algorithm>
#include <cmath>

namespace polemcl::report {
namespace {

std::vector<double> relativeWeights(const std::vector<double>& logWeights) {
  if (logWeights.empty()) return {};
  const double most = *std::max_element(logWeights.begin(), logWeights.end());
  std::vector<double> weights;
  weights.reserve(logWeights.size());
  for (double logWeight : logWeights) weights.push_back(std::exp(logWeight - most));
  return weights;
}

}  // namespace

void Way::add(const LocalizationUpdate& update) {
  std::optional<Pose2D> pose;
  if (update.estimate) pose = update.estimate->mean;
  add(pose, update.relocalized, update.health.state);
}

void Way::add(const std::optional<Pose2D>& pose, bool jumped, HealthState state) {
  const std::size_t scan = m_scans++;
  if (jumped || !pose) m_broken = true;
  if (!pose) return;
  if (m_provisional && !m_broken) m_points.pop_back();
  const bool far =
      m_broken || std::hypot(pose->x - m_points.back().x, pose->y - m_points.back().y) >= spacing;
  m_worst = m_broken ? state : std::max(m_worst, state);
  m_points.push_back({pose->x, pose->y, !m_broken, m_worst, scan});
  if (far) m_worst = HealthState::ok;
  m_provisional = !far;
  m_broken = false;
}

std::vector<WayPoint> Way::until(std::size_t scan, const std::optional<Pose2D>& pose,
                                 HealthState state) const {
  const auto end =
      std::upper_bound(m_points.begin(), m_points.end(), scan,
                       [](std::size_t limit, const WayPoint& point) { return limit < point.scan; });
  std::vector<WayPoint> way(m_points.begin(), end);
  const bool stayed = !way.empty() && way.back().scan == scan;
  if (pose && !stayed) way.push_back({pose->x, pose->y, true, state, scan});
  return way;
}

LiveMoment momentOf(const LocalizationPipeline& localization, const PoleScan& frame,
                    const LocalizationUpdate& update, std::size_t scan, double start) {
  LiveMoment moment;
  moment.scan = scan;
  moment.elapsed = frame.time - start;
  moment.estimate = update.estimate;
  moment.poles_robot = frame.poles_robot;
  if (localization.hasPose()) {
    moment.particles = localization.filter().particles();
    moment.weights = relativeWeights(localization.filter().logWeights());
    moment.matches = localization.matches();
  }
  // Those of a search long ago lie where the vehicle was then.
  if (update.health.state != HealthState::ok)
    moment.hypotheses = localization.lastSearch().hypotheses;
  moment.health = update.health;
  moment.step = update.step;
  moment.relocalized = update.relocalized;
  return moment;
}

std::optional<double> positionError(const LiveMoment& moment) {
  if (!moment.estimate || !moment.truth) return std::nullopt;
  const Pose2D& pose = moment.estimate->mean;
  return std::hypot(pose.x - moment.truth->x, pose.y - moment.truth->y);
}

}  // namespace polemcl::report
