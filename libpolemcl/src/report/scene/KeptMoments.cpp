#include "report/scene/KeptMoments.h"

#include <algorithm>
#include <utility>

namespace polemcl::report {

KeptMoments::Kept KeptMoments::kept(const LiveMoment& moment) {
  Kept kept{moment.elapsed,
            moment.estimate,
            moment.truth,
            moment.health,
            moment.step,
            moment.relocalized,
            false,
            {},
            {},
            moment.hypotheses};
  kept.hypotheses.resize(std::min(kept.hypotheses.size(), mostHypotheses));
  kept.associated = moment.matches.size() == moment.poles_robot.size();
  const auto single = [](double value) { return static_cast<float>(value); };
  kept.poles.reserve(moment.poles_robot.size());
  for (std::size_t i = 0; i < moment.poles_robot.size(); ++i) {
    const PoleDetection& pole = moment.poles_robot[i];
    kept.poles.push_back({single(pole.x), single(pole.y), single(pole.radius), single(pole.bottom),
                          single(pole.top), kept.associated && moment.matches[i].matched});
  }
  if (!moment.estimate) return kept;
  // Evenly by their number: the weights stay as they are.
  const Pose2D& centre = moment.estimate->mean;
  const std::size_t all = moment.particles.size(), some = std::min(all, mostParticles);
  kept.particles.reserve(some);
  for (std::size_t k = 0; k < some; ++k) {
    const std::size_t i = k * all / some;
    kept.particles.push_back({single(moment.particles[i].x - centre.x),
                              single(moment.particles[i].y - centre.y), single(moment.weights[i])});
  }
  return kept;
}

LiveMoment KeptMoments::restored(const Kept& kept) {
  LiveMoment moment;
  moment.elapsed = kept.elapsed;
  moment.estimate = kept.estimate;
  moment.truth = kept.truth;
  moment.health = kept.health;
  moment.step = kept.step;
  moment.relocalized = kept.relocalized;
  moment.hypotheses = kept.hypotheses;
  for (const Pole& pole : kept.poles) {
    PoleDetection seen;
    seen.x = pole.x, seen.y = pole.y, seen.radius = pole.radius;
    seen.bottom = pole.bottom, seen.top = pole.top;
    moment.poles_robot.push_back(seen);
    if (!kept.associated) continue;
    moment.matches.emplace_back();
    moment.matches.back().matched = pole.matched;
  }
  for (const Particle& particle : kept.particles) {
    const Pose2D& centre = kept.estimate->mean;
    moment.particles.push_back({centre.x + particle.x, centre.y + particle.y, centre.yaw});
    moment.weights.push_back(particle.weight);
  }
  return moment;
}

void KeptMoments::add(LiveMoment moment) {
  std::optional<Pose2D> pose;
  if (moment.estimate) pose = moment.estimate->mean;
  m_way.add(pose, moment.relocalized, moment.health.state);
  m_trueWay.add(moment.truth, false);
  m_errors.push_back(static_cast<float>(positionError(moment).value_or(-1)));
  m_kept.push_back(kept(moment));
  if (m_kept.size() > mostScans) m_kept.pop_front();
  m_newest = std::move(moment);
}

LiveMoment KeptMoments::at(std::size_t scan) const {
  LiveMoment moment = scan == m_newest.scan ? m_newest : restored(m_kept[scan - oldest()]);
  moment.scan = scan;
  std::optional<Pose2D> pose;
  if (moment.estimate) pose = moment.estimate->mean;
  moment.way = m_way.until(scan, pose, moment.health.state);
  moment.trueWay = m_trueWay.until(scan, moment.truth);
  return moment;
}

}  // namespace polemcl::report
