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
  if (update.relocalized || !update.estimate) m_broken = true;
  if (!update.estimate) return;
  const Pose2D& pose = update.estimate->mean;
  if (m_provisional && !m_broken) m_points.pop_back();
  const bool far =
      m_broken || std::hypot(pose.x - m_points.back().x, pose.y - m_points.back().y) >= spacing;
  m_points.push_back({pose.x, pose.y, !m_broken});
  m_provisional = !far;
  m_broken = false;
}

LiveMoment momentOf(const LocalizationPipeline& localization, const PoleScan& frame,
                    const LocalizationUpdate& update, std::size_t scan, double start,
                    const Way& way) {
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
  moment.way = way.points();
  return moment;
}

}  // namespace polemcl::report
