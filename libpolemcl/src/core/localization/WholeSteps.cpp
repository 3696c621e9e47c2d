#include "core/localization/WholeSteps.h"

#include <algorithm>
#include <cmath>

namespace polemcl {
namespace {

constexpr int kMostJoined = 20;       // motions in a step: a stall of a second at 20 Hz
constexpr double kLongShare = 1.5;    // of the usual length; beyond it, the scan may come late
constexpr double kLongestStall = 1;   // s; who sends less often has slowed down
constexpr double kSameSpeed = 0.8;    // least share of the speed before that is the same
constexpr double kAcceleration = 10;  // m/s²; no vehicle has more

double speedOf(const TimedMotion& step) {
  return std::hypot(step.motion.x, step.motion.y) / step.seconds;
}

}  // namespace

TimedMotion WholeSteps::joined(const Pose2D& motion, double seconds) const {
  if (m_restCount == 0) return {motion, seconds};
  return {compose(m_rest.motion, motion), m_rest.seconds + seconds};
}

bool WholeSteps::tellsSpeed(const TimedMotion& step) const {
  return step.seconds >= leastShare * m_usual && speedOf(step) <= fastest;
}

/// A motion much shorter than usual ends no step, nor does one that is longer, up to a second,
/// and slower; unless the speed stays the same. Short ones end a step together if no longer one is
/// among them: after a halt, scans come more often again.
bool WholeSteps::ends(const Pose2D& motion, double seconds) const {
  if (m_restCount + 1 >= kMostJoined) return true;
  const double speed = speedOf(joined(motion, seconds));
  if (m_restCount == 0 && speed > fastest) return false;
  const bool isSlower = m_speed && speed < kSameSpeed * *m_speed;
  if (seconds >= leastShare * m_usual)
    return seconds <= kLongShare * m_usual || seconds > kLongestStall || !isSlower;
  if (m_restCount == 0) return m_speed && !isSlower && kSameSpeed * speed <= *m_speed;
  const double together = m_rest.seconds + seconds;
  return m_restIsShort && m_speed && together >= leastShare * m_usual &&
         speed <= *m_speed + kAcceleration * together;
}

bool WholeSteps::isOpen(const Pose2D& motion, double seconds) const {
  const bool isTooShort = seconds < leastShare * m_usual;
  return !ends(motion, seconds) && (isTooShort || speedOf(joined(motion, seconds)) <= fastest);
}

std::optional<TimedMotion> WholeSteps::add(const Pose2D& motion, double seconds) {
  const TimedMotion step = joined(motion, seconds);
  if (!ends(motion, seconds)) {
    m_restIsShort = m_restIsShort && seconds < leastShare * m_usual;
    m_rest = step;
    ++m_restCount;
    return std::nullopt;
  }
  // Short steps one by one leave it: they may be a burst while the vehicle stands. So do long gaps:
  // the vehicle may stand, where scans are kept by the way between them.
  if ((m_restCount > 0 || seconds >= leastShare * m_usual) && seconds <= kLongestStall)
    m_usual = std::clamp(step.seconds / (m_restCount + 1), 0.5 * m_usual, 2 * m_usual);
  beginStep();
  if (speedOf(step) > fastest) return std::nullopt;
  m_speed = speedOf(step);
  return step;
}

void WholeSteps::beginStep() {
  m_rest = {};
  m_restCount = 0;
  m_restIsShort = true;
}

}  // namespace polemcl
