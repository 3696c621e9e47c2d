#include "eval/FaultInjection.h"

#include <algorithm>
#include <cmath>

#include "core/common/Angles.h"
#include "core/common/PoseInterpolation.h"
#include "core/common/Transform.h"
#include "io/data/PlanarMotion.h"
#include "io/file/TextFile.h"
#include "mrpt/rawlog/RawlogWriter.h"

namespace polemcl::apps {
namespace {

constexpr double kLongestDelay = 1;  // of a scan that comes late, s

class Injector {
 public:
  Injector(const TrialDrive& drive, const FaultOptions& options, std::mt19937_64& random)
      : m_drive(drive), m_options(options), m_random(random) {}

  Trial inject() {
    if (m_options.fault == Fault::none) {
      append(0, m_drive.frames.size());
      m_trial.begin = m_trial.end = m_trial.frames.size();
    } else if (m_options.fault == Fault::wrongMap) {
      m_trial.origin = drawStart(0, 0);
      append(m_trial.origin, scanAfterMetres(m_trial.origin));
    } else if (m_options.fault == Fault::kidnap) {
      kidnap();
    } else if (m_options.fault == Fault::jump) {
      jump();
    } else {
      spoil();
    }
    m_trial.start = m_trial.truth.at(0);
    return std::move(m_trial);
  }

 private:
  double time(std::size_t i) const { return m_drive.frames[i].time; }

  std::size_t scanAfterSeconds(std::size_t from, double seconds) const {
    std::size_t i = from;
    while (i < m_drive.frames.size() && time(i) - time(from) < seconds - 1e-6) ++i;
    return i;
  }
  /// The scan that is the tail's length farther along, or the end.
  std::size_t scanAfterMetres(std::size_t from) const {
    const auto& driven = m_drive.driven;
    const auto at = std::lower_bound(driven.begin() + static_cast<std::ptrdiff_t>(from),
                                     driven.end(), driven[from] + m_options.tail);
    return static_cast<std::size_t>(at - driven.begin());
  }
  bool tailFits(std::size_t from) const {
    return m_drive.driven.back() - m_drive.driven[from] >= m_options.tail;
  }
  bool fits(std::size_t start, double lead, double lasting) const {
    const std::size_t begin = scanAfterSeconds(start, lead);
    if (begin >= m_drive.frames.size()) return false;
    const std::size_t end = scanAfterSeconds(begin, lasting);
    return end < m_drive.frames.size() && tailFits(end);
  }
  /// A scan from which lead, fault and tail fit into the drive, uniform among them.
  std::size_t drawStart(double lead, double lasting) const {
    // The later the start, the less is left: bisection finds the last that fits.
    if (m_drive.frames.empty() || !fits(0, lead, lasting))
      throw Error("the drive of " + std::to_string(m_drive.frames.size()) +
                  " scans is too short: lead " + io::fixed(lead, 1) + " s, fault " +
                  io::fixed(lasting, 1) + " s and tail " + io::fixed(m_options.tail, 1) +
                  " m must fit into it");
    std::size_t good = 0, bad = m_drive.frames.size();
    while (bad - good > 1) {
      const std::size_t middle = (good + bad) / 2;
      (fits(middle, lead, lasting) ? good : bad) = middle;
    }
    return m_random() % (good + 1);
  }

  /// Scans `from` to `to`. After a jump the clock goes on as before.
  void append(std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      PoleScan frame = m_drive.frames[i];
      double driven = 0;
      if (!m_trial.frames.empty()) {
        const double step = time(i) - time(i - 1);
        const bool jumps = i == from;
        frame.time = m_trial.frames.back().time + (jumps ? std::max(step, 1e-3) : step);
        driven = m_trial.driven.back() + (jumps ? 0 : m_drive.driven[i] - m_drive.driven[i - 1]);
      }
      m_trial.driven.push_back(driven);
      m_trial.frames.push_back(std::move(frame));
      m_trial.truth.push_back(m_drive.truth[i]);
    }
  }

  void kidnap() {
    m_trial.origin = drawStart(m_options.lead, 0);
    const std::size_t from = scanAfterSeconds(m_trial.origin, m_options.lead);
    const std::size_t to = drawJump(from);
    append(m_trial.origin, from);
    m_trial.begin = m_trial.end = m_trial.frames.size();
    append(to, scanAfterMetres(to));
    m_trial.jump = errorOf(m_drive.truth[to], m_drive.truth[from]).metres;
  }

  /// A scan as far away as drawn, within 5 m; from it, the tail fits in.
  std::size_t drawJump(std::size_t from) const {
    for (int attempt = 0; attempt < 100; ++attempt) {
      const double wanted = uniform(m_random, m_options.minJump, m_options.maxJump);
      std::vector<std::size_t> places;
      for (std::size_t i = 1; i < m_drive.frames.size() && tailFits(i); ++i) {
        const double distance = errorOf(m_drive.truth[i], m_drive.truth[from]).metres;
        if (std::abs(distance - wanted) < 5 && distance >= m_options.minJump &&
            distance <= m_options.maxJump)
          places.push_back(i);
      }
      if (!places.empty()) return places[m_random() % places.size()];
    }
    throw Error("no place of the drive lies " + io::fixed(m_options.minJump, 0) + " to " +
                io::fixed(m_options.maxJump, 0) + " m from its scan " + std::to_string(from));
  }

  void jump() {
    m_trial.origin = drawStart(m_options.lead, 0);
    const std::size_t from = scanAfterSeconds(m_trial.origin, m_options.lead);
    append(m_trial.origin, scanAfterMetres(from));
    m_trial.begin = from - m_trial.origin;
    m_trial.jump = uniform(m_random, m_options.minShift, m_options.maxShift);
    const double direction = uniform(m_random, -M_PI, M_PI);
    const Pose2D shift{m_trial.jump * std::cos(direction), m_trial.jump * std::sin(direction), 0};
    const bool returns = m_random() % 2 == 0;
    m_trial.end = m_trial.begin + (returns ? 2 : 1);
    for (std::size_t i = m_trial.begin; i < m_trial.end; ++i) {
      if (!m_trial.frames[i].motion) continue;
      Pose2D& mean = m_trial.frames[i].motion->mean;
      mean = compose(i == m_trial.begin ? shift : Pose2D{-shift.x, -shift.y, 0}, mean);
    }
  }

  /// A fault that lasts.
  void spoil() {
    m_trial.origin = drawStart(m_options.lead, m_options.duration);
    const std::size_t begin = scanAfterSeconds(m_trial.origin, m_options.lead);
    const std::size_t end = scanAfterSeconds(begin, m_options.duration);
    append(m_trial.origin, scanAfterMetres(end));
    m_trial.begin = begin - m_trial.origin;
    m_trial.end = end - m_trial.origin;
    const int sign = m_random() % 2 == 0 ? 1 : -1;
    switch (m_options.fault) {
      case Fault::slip:
        return slip(1 + sign * m_options.slip);
      case Fault::clock:
        return shiftClock(sign * uniform(m_random, 0.1, 0.5));
      case Fault::moved:
        return moveLidarBehind(sign);
      case Fault::halfGone:
        return hideHalf();
      case Fault::snow:
        return addFalsePoles();
      case Fault::late:
        return delayScans();
      default:
        for (std::size_t i = m_trial.begin; i < m_trial.end; ++i) {
          PoleScan& frame = m_trial.frames[i];
          if (m_options.fault == Fault::blind) frame.poles_robot.clear();
          if (m_options.fault == Fault::stuck && frame.motion) frame.motion = standstill();
        }
    }
  }

  void slip(double factor) {
    for (std::size_t i = m_trial.begin; i < m_trial.end; ++i) {
      if (!m_trial.frames[i].motion) continue;
      PoseWithCovariance& motion = *m_trial.frames[i].motion;
      motion.mean = {factor * motion.mean.x, factor * motion.mean.y, factor * motion.mean.yaw};
      motion.covariance *= factor * factor;
    }
  }

  void shiftClock(double seconds) {
    std::vector<StampedPose2D> path;  // of the odometry
    for (const PoleScan& frame : m_trial.frames) {
      const Pose2D last = path.empty() ? Pose2D{} : path.back().pose;
      const bool moves = !path.empty() && frame.motion;
      path.push_back({frame.time, moves ? compose(last, frame.motion->mean) : last});
    }
    for (std::size_t i = std::max<std::size_t>(m_trial.begin, 1); i < m_trial.end; ++i) {
      const auto from = poseAt(path, path[i - 1].time + seconds, INFINITY);
      const auto to = poseAt(path, path[i].time + seconds, INFINITY);
      if (from && to && m_trial.frames[i].motion)
        m_trial.frames[i].motion->mean = relative(*from, *to);
    }
  }

  void moveLidarBehind(int sign) {
    const double metres = uniform(m_random, 0.1, 0.5), direction = uniform(m_random, -M_PI, M_PI);
    const Pose2D shift{metres * std::cos(direction), metres * std::sin(direction),
                       sign * uniform(m_random, 1, 5) * degree};
    for (std::size_t i = m_trial.begin; i < m_trial.end; ++i)
      for (PoleDetection& pole : m_trial.frames[i].poles_robot)
        if (pole.x < 0) pole = moved(shift, pole);
  }

  void hideHalf() {
    std::vector<bool> isGone(m_drive.map.poles->poles().size());
    for (std::size_t i = 0; i < isGone.size(); ++i) isGone[i] = m_random() % 2 == 0;
    const auto isHidden = [&](const PoleDetection& pole, const Pose2D& pose) {
      const Eigen::Vector2d centre = movedCentre(pose, pole).centre;
      const auto nearest = m_drive.map.poles->index().nearest(centre.x(), centre.y(), 1);
      return nearest && isGone[nearest->index];
    };
    for (std::size_t i = m_trial.begin; i < m_trial.end; ++i) {
      auto& seen = m_trial.frames[i].poles_robot;
      seen.erase(std::remove_if(
                     seen.begin(), seen.end(),
                     [&](const PoleDetection& pole) { return isHidden(pole, m_trial.truth[i]); }),
                 seen.end());
    }
  }

  /// A false pole is one of this stretch, turned round the vehicle by any angle.
  void addFalsePoles() {
    std::vector<PoleDetection> all;
    for (const PoleScan& frame : m_trial.frames)
      all.insert(all.end(), frame.poles_robot.begin(), frame.poles_robot.end());
    if (all.empty()) return;
    const std::size_t count = 2 * all.size() / m_trial.frames.size();
    for (std::size_t i = m_trial.begin; i < m_trial.end; ++i)
      for (std::size_t k = 0; k < count; ++k) {
        const PoleDetection& pole = all[m_random() % all.size()];
        m_trial.frames[i].poles_robot.push_back(
            moved({0, 0, uniform(m_random, -M_PI, M_PI)}, pole));
      }
  }

  /// The times of the scans stay the true ones.
  void delayScans() {
    std::vector<double> arrivals;
    for (std::size_t i = 0; i < m_trial.frames.size(); ++i) {
      const bool isLate = i >= m_trial.begin && i < m_trial.end;
      arrivals.push_back(m_trial.frames[i].time +
                         (isLate ? uniform(m_random, 0, kLongestDelay) : 0));
    }
    keepOnly(usedScans(arrivals));
  }

  /// The motion to a scan that is left out goes on to the next one.
  void keepOnly(const std::vector<std::size_t>& used) {
    const Trial all = std::move(m_trial);
    const auto usedBefore = [&](std::size_t scan) {
      return static_cast<std::size_t>(std::lower_bound(used.begin(), used.end(), scan) -
                                      used.begin());
    };
    m_trial = Trial();
    m_trial.origin = all.origin;
    m_trial.begin = usedBefore(all.begin);
    m_trial.end = usedBefore(all.end);
    std::optional<PoseWithCovariance> moved;
    std::size_t next = 0;
    for (std::size_t i = 0; i < all.frames.size() && next < used.size(); ++i) {
      const auto& motion = all.frames[i].motion;
      moved = moved && motion ? io::composeMotions(*moved, *motion) : motion;
      if (i != used[next]) continue;
      m_trial.frames.push_back(all.frames[i]);
      m_trial.frames.back().motion = moved;
      m_trial.truth.push_back(all.truth[i]);
      m_trial.driven.push_back(all.driven[i]);
      moved.reset();
      ++next;
    }
  }

  const TrialDrive& m_drive;
  const FaultOptions& m_options;
  std::mt19937_64& m_random;
  Trial m_trial;
};

}  // namespace

const char* name(Fault fault) {
  static constexpr const char* kNames[] = {"none",  "kidnap",    "wrong-map", "blind",
                                           "stuck", "slip",      "jump",      "clock",
                                           "moved", "half-gone", "snow",      "late"};
  return kNames[static_cast<int>(fault)];
}

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

std::vector<std::size_t> usedScans(const std::vector<double>& arrivals) {
  std::vector<std::size_t> used;
  double first = INFINITY;  // arrival of those after scan i
  for (std::size_t i = arrivals.size(); i-- > 0;) {
    if (arrivals[i] <= first) used.push_back(i);
    first = std::min(first, arrivals[i]);
  }
  std::reverse(used.begin(), used.end());
  return used;
}

Trial injectFault(const TrialDrive& drive, const FaultOptions& options, std::mt19937_64& random) {
  return Injector(drive, options, random).inject();
}

}  // namespace polemcl::apps
