#pragma once
/// \file FrameTree.h
/// \brief Static transforms between the frames of a robot.

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>

namespace polemcl::io {

/// \brief Frames, each with its pose in its parent.
class FrameTree {
 public:
  /// \brief Sets the pose of a frame; a later one replaces the earlier one.
  void add(const std::string& parent, const std::string& child,
           const Eigen::Isometry3d& T_parent_child);

  /// \brief The pose of `frame` in `base`, m; identity if both are one. \return Nothing if they are
  /// not connected.
  std::optional<Eigen::Isometry3d> find(const std::string& base, const std::string& frame) const;

 private:
  struct Link {
    std::string parent;
    Eigen::Isometry3d T_parent_child;
  };
  /// The frames above one and itself, with its pose in each of them.
  std::map<std::string, Eigen::Isometry3d> above(const std::string& frame) const;

  std::map<std::string, Link> m_links;  ///< by the name of the child
};

}  // namespace polemcl::io
