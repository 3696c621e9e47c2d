#include "core/localization/WholeSteps.h"

#include <algorithm>
#include <cmath>

namespace polemcl {
namespace {

constexpr int kMostJoined = 3;  // motions in a step

}  // namespace

TimedMotion WholeSteps::joined(const Pose2D& motion, double seconds) const {
  if (m_restCount == 0) return {motion, seconds};
  return {compose(m_rest.motion, motion), m_rest.seconds + seconds};
}

bool WholeSteps::tellsSpeed(const TimedMotion& step) const {
  return step.seconds >= leastShare * m_usual &&
         std::hypot(step.motion.x, step.motion.y) <= fastest * step.seconds;
}

std::optional<TimedMotion> WholeSteps::add(const Pose2D& motion, double seconds) {
  const TimedMotion step = joined(motion, seconds);
  if (tellsSpeed(step)) {
    // One long step is a gap: the next may be as short as those before.
    m_usual = std::min(step.seconds, 2 * m_usual);
    beginStep();
    return step;
  }
  m_rest = step;
  if (++m_restCount < kMostJoined) return std::nullopt;
  m_usual = seconds;  // scans come faster now
  beginStep();
  return std::nullopt;
}

void WholeSteps::beginStep() {
  m_rest = {};
  m_restCount = 0;
}

}  // namespace polemcl
