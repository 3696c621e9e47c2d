#pragma once
/// \file KdTree2D.h
/// \brief Exact searches over points of the plane, on nanoflann; never changes once built. All
/// searches but those of PoleGrid.h.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace polemcl {

/// \brief What a search over points found.
struct PointHit {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t index = none;  ///< into the points given to the constructor; `none` without a hit
  double squaredDistance = 0;  ///< m², dx² + dy² in that order; 0 for `none`
  explicit operator bool() const { return index != none; }
};

/// \brief k-d tree over points of the plane. Built eagerly; const calls may run in parallel.
class KdTree2D {
 public:
  /// \throws Error naming the first point with a coordinate that is not finite.
  explicit KdTree2D(std::vector<Eigen::Vector2d> points);
  ~KdTree2D();
  KdTree2D(KdTree2D&&) noexcept;
  KdTree2D& operator=(KdTree2D&&) noexcept;

  std::size_t size() const;
  const Eigen::Vector2d& point(std::size_t index) const;
  /// \brief Nearest point with squared distance < radius². The lower index wins a tie.
  /// A query or radius that is not a number finds nothing.
  PointHit nearest(double x, double y, double radius) const;
  /// \brief All points with squared distance < radius², by ascending index; `out` is replaced.
  void within(double x, double y, double radius, std::vector<PointHit>& out) const;
  /// \brief The same unless there are more than `most`: then false, and `out` is to be thrown away.
  /// Looks at no more than that.
  bool withinUnlessMore(double x, double y, double radius, std::size_t most,
                        std::vector<PointHit>& out) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

}  // namespace polemcl
