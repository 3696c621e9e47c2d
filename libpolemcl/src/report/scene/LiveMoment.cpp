#include "report/scene/LiveMoment.h"

#include <mrpt/poses/CPose3D.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "mrpt/observation/ObservationPoints.h"

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

constexpr std::size_t kMost = 50000;

using Points = std::vector<mrpt::math::TPoint3Df>;

void append(Points& points, const mrpt::obs::CObservation& source,
            const ObservationPoleExtractorOptions& options) {
  ObservationPoints reader(options.sensor);
  const ObservationPoints::Loan loan(reader);
  const PointsView cloud = reader.read(source);
  const mrpt::poses::CPose3D pose = options.poseOf(source);
  for (std::size_t i = 0; i < cloud.size; ++i) {
    const mrpt::math::TPoint3D point(cloud.x[i], cloud.y[i], cloud.z[i]);
    const double range = point.norm();
    if (!std::isfinite(range) || range == 0) continue;
    const mrpt::math::TPoint3D place = pose.composePoint(point);
    points.emplace_back(static_cast<float>(place.x), static_cast<float>(place.y),
                        static_cast<float>(place.z));
  }
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

Points scanPoints(const std::vector<mrpt::obs::CObservation::Ptr>& sources,
                  const SequenceOptions& reading) {
  Points points;
  for (const auto& source : sources) {
    const auto lidar = reading.vehicle.indexOf(source->sensorLabel);
    append(points, *source,
           lidar ? reading.vehicle.lidars[*lidar].extractor() : reading.extraction);
  }
  if (points.size() <= kMost) return points;
  for (std::size_t k = 0; k < kMost; ++k) points[k] = points[k * points.size() / kMost];
  points.resize(kMost);
  return points;
}

}  // namespace polemcl::report
