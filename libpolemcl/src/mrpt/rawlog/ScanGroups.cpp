#include "mrpt/rawlog/ScanGroups.h"

#include <algorithm>

namespace polemcl {

ScanGroups::ScanGroups(const VehicleOptions& vehicle)
    : m_within(vehicle.fuseWithin), m_wait(vehicle.wait), m_latest(vehicle.lidars.size()) {}

bool ScanGroups::add(LidarScan scan) {
  m_reached = std::max(m_reached.value_or(scan.time), scan.time);
  auto& latest = m_latest[scan.lidar];
  latest = std::max(latest.value_or(scan.time), scan.time);
  if (m_given && scan.time <= *m_given) return false;
  const auto after =
      std::upper_bound(m_waiting.begin(), m_waiting.end(), scan.time,
                       [](double time, const Waiting& other) { return time < other.scan.time; });
  m_waiting.insert(after, {std::move(scan), m_arrived++});
  return true;
}

/// Number of waiting scans that form the first group, as far as is known.
std::size_t ScanGroups::leading() const {
  if (m_waiting.empty()) return 0;
  const LidarScan& first = m_waiting.front().scan;
  std::vector<bool> seen(m_latest.size());
  std::size_t count = 0;
  for (const auto& [scan, arrived] : m_waiting) {
    const bool isNear = scan.time - first.time <= m_within;
    const bool sameMotion = first.motions > 0 && scan.motions == first.motions;
    if (seen[scan.lidar] || !(isNear || sameMotion)) break;
    seen[scan.lidar] = true;
    ++count;
  }
  return count;
}

/// Whether a scan of this LiDAR may come that belongs to the group that starts at `first`.
bool ScanGroups::canStillCome(std::size_t lidar, double first) const {
  if (m_latest[lidar] && *m_latest[lidar] >= first) return false;
  return !(m_reached && *m_reached > first + m_within + m_wait);
}

bool ScanGroups::isComplete(std::size_t count) const {
  const double first = m_waiting.front().scan.time;
  for (std::size_t lidar = 0; lidar < m_latest.size(); ++lidar)
    if (canStillCome(lidar, first)) return false;
  return count > 0;
}

std::vector<LidarScan> ScanGroups::next(bool ended) {
  const std::size_t count = leading();
  if (count == 0 || !(ended || isComplete(count))) return {};
  const auto end = m_waiting.begin() + static_cast<std::ptrdiff_t>(count);
  m_given = std::prev(end)->scan.time;
  std::sort(m_waiting.begin(), end,
            [](const Waiting& a, const Waiting& b) { return a.arrived < b.arrived; });
  std::vector<LidarScan> group;
  for (auto each = m_waiting.begin(); each != end; ++each) group.push_back(std::move(each->scan));
  m_waiting.erase(m_waiting.begin(), end);
  return group;
}

}  // namespace polemcl
