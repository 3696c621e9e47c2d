#include "core/common/PathSections.h"

#include <algorithm>
#include <cmath>

namespace polemcl {
namespace {

/// Distance travelled at each pose of one path, never decreasing.
class Odometer {
 public:
  explicit Odometer(double step) : m_step(step) {}
  double at(const Pose2D& pose) {
    if (!m_started) {
      m_started = true;
      m_anchor = pose;
    }
    const double away = std::hypot(pose.x - m_anchor.x, pose.y - m_anchor.y);
    m_travelled = std::max(m_travelled, m_travelledToAnchor + away);
    if (away >= m_step) {
      m_anchor = pose;
      m_travelledToAnchor = m_travelled;
    }
    return m_travelled;
  }

 private:
  double m_step;
  bool m_started = false;
  Pose2D m_anchor;
  double m_travelledToAnchor = 0, m_travelled = 0;
};

}  // namespace

void SectionMarks::pass(double travelled) {
  m_middle = travelled >= static_cast<double>(m_middles) * m_length + 0.5 * m_length;
  m_end = travelled > static_cast<double>(m_ends) * m_length + m_length;
  m_middles += m_middle;
  m_ends += m_end;
}

PathSections passSections(const std::vector<Pose2D>& poses,
                          const std::vector<std::uint32_t>& drives, double sectionLength,
                          const std::vector<bool>& used) {
  PathSections result;
  std::uint32_t path = 0;
  std::vector<std::size_t> middles;
  const auto finish = [&](const SectionMarks& marks, double travelled) {
    for (std::size_t k = 0; k < marks.ends(); ++k)
      if (used.empty() || used[middles[k]])
        result.occupied.push_back({path, k, {middles[k]}, middles[k]});
    result.count = result.occupied.size();
    result.length += travelled;
    middles.clear();
    ++path;
  };
  SectionMarks marks(sectionLength);
  double travelled = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i > 0 && drives[i] != drives[i - 1]) {
      finish(marks, travelled);
      marks = SectionMarks(sectionLength);
      travelled = 0;
    } else if (i > 0) {
      travelled += std::hypot(poses[i].x - poses[i - 1].x, poses[i].y - poses[i - 1].y);
    }
    marks.pass(travelled);
    if (marks.middle()) middles.push_back(i);
  }
  finish(marks, travelled);
  return result;
}

PathSections splitPath(const std::vector<Pose2D>& poses, const std::vector<std::uint32_t>& drives,
                       double sectionLength, const std::vector<bool>& used) {
  // A quarter of a section: much longer than jitter of poses, much shorter than bends of roads.
  const double step = sectionLength / 4;
  PathSections result;
  Odometer odometer(step);
  std::uint32_t path = 0;
  double lengthBefore = 0, nearest = 0;
  std::size_t next = 0;  // section of this path after that of the pose before
  const auto isUsed = [&](std::size_t i) { return used.empty() || used[i]; };
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i > 0 && drives[i] != drives[i - 1]) {
      ++path;
      next = 0;
      lengthBefore = result.length;
      odometer = Odometer(step);
    }
    const double travelled = odometer.at(poses[i]) / sectionLength;
    // Rounding may leave whole numbers of sections slightly too small.
    const auto index = static_cast<std::size_t>(std::floor(travelled + 1e-9));
    const double fromMiddle = std::abs(travelled - (static_cast<double>(index) + 0.5));
    result.length = lengthBefore + travelled * sectionLength;
    if (index > next && isUsed(i) && isUsed(i - 1)) result.count += index - next;
    next = index + 1;
    if (!isUsed(i)) continue;
    const bool opens = result.occupied.empty() || result.occupied.back().path != path ||
                       result.occupied.back().index != index;
    if (opens) {
      result.occupied.push_back({path, index, {}, i});
      ++result.count;
    }
    PathSection& section = result.occupied.back();
    if (opens || fromMiddle < nearest - 1e-9) {
      nearest = fromMiddle;
      section.middle = i;
    }
    section.scans.push_back(i);
  }
  return result;
}

}  // namespace polemcl
