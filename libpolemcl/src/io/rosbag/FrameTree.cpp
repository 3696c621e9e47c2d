#include "io/rosbag/FrameTree.h"

namespace polemcl::io {

void FrameTree::add(const std::string& parent, const std::string& child,
                    const Eigen::Isometry3d& T_parent_child) {
  m_links.insert_or_assign(child, Link{parent, T_parent_child});
}

std::map<std::string, Eigen::Isometry3d> FrameTree::above(const std::string& frame) const {
  std::map<std::string, Eigen::Isometry3d> poses;
  std::string at = frame;
  Eigen::Isometry3d T_at_frame = Eigen::Isometry3d::Identity();
  while (poses.emplace(at, T_at_frame).second) {  // ends in a circle, too
    const auto link = m_links.find(at);
    if (link == m_links.end()) break;
    T_at_frame = link->second.T_parent_child * T_at_frame;
    at = link->second.parent;
  }
  return poses;
}

std::optional<Eigen::Isometry3d> FrameTree::find(const std::string& base,
                                                 const std::string& frame) const {
  const auto aboveBase = above(base), aboveFrame = above(frame);
  // All common ancestors give the same pose.
  for (const auto& [name, T_common_frame] : aboveFrame)
    if (const auto common = aboveBase.find(name); common != aboveBase.end())
      return common->second.inverse() * T_common_frame;
  return std::nullopt;
}

}  // namespace polemcl::io
