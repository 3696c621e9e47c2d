#include "core/common/KdTree2D.h"

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>
#include <utility>

#include <polemcl/core/common/Types.h>

namespace polemcl {
namespace {

/// What nanoflann reads the points through.
struct TreePoints {
  std::vector<Eigen::Vector2d> points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t index, std::size_t axis) const { return points[index][axis]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, TreePoints>,
                                                 TreePoints, 2, std::uint32_t>;

/// nanoflann sums up its lower bounds with rounding and passes on only what is nearer than
/// `worstDist`: a bound a little too wide keeps every tie in sight, `addPoint` then decides
/// exactly.
double widened(double squaredDistance) {
  return squaredDistance * (1 + 1e-12) + 1e-300;
}

class NearestResult {
 public:
  using DistanceType = double;
  using IndexType = std::uint32_t;  // asked for by nanoflann 1.12
  explicit NearestResult(double squaredRadius) : m_limit(squaredRadius) {}
  bool full() const { return true; }
  double worstDist() const { return widened(m_limit); }
  bool addPoint(double squaredDistance, std::uint32_t index) {
    const bool better =
        m_hit ? squaredDistance < m_limit || (squaredDistance == m_limit && index < m_hit.index)
              : squaredDistance < m_limit;
    if (better) {
      m_hit = {index, squaredDistance};
      m_limit = squaredDistance;
    }
    return true;
  }
  void sort() {}  // asked for by nanoflann from 1.5 on
  PointHit hit() const { return m_hit; }

 private:
  double m_limit;
  PointHit m_hit;
};

class WithinResult {
 public:
  using DistanceType = double;
  using IndexType = std::uint32_t;  // asked for by nanoflann 1.12
  WithinResult(double squaredRadius, std::size_t most, std::vector<PointHit>& out)
      : m_limit(squaredRadius), m_most(most), m_out(out) {}
  bool full() const { return true; }
  double worstDist() const { return widened(m_limit); }
  bool addPoint(double squaredDistance, std::uint32_t index) {
    if (squaredDistance < m_limit) m_out.push_back({index, squaredDistance});
    return !isTooMuch();  // false ends the search
  }
  bool isTooMuch() const { return m_out.size() > m_most; }
  void sort() {}  // within() sorts by index

 private:
  double m_limit;
  std::size_t m_most;
  std::vector<PointHit>& m_out;
};

}  // namespace

struct KdTree2D::Impl {
  explicit Impl(std::vector<Eigen::Vector2d> points)
      : data{std::move(points)}, tree(2, data, nanoflann::KDTreeSingleIndexAdaptorParams(8)) {}
  TreePoints data;
  Tree tree;
};

KdTree2D::KdTree2D(std::vector<Eigen::Vector2d> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) {
      throw Error("point " + std::to_string(i) + " has a coordinate that is not finite; remove it");
    }
  }
  m_impl = std::make_unique<Impl>(std::move(points));
}
KdTree2D::~KdTree2D() = default;
KdTree2D::KdTree2D(KdTree2D&&) noexcept = default;
KdTree2D& KdTree2D::operator=(KdTree2D&&) noexcept = default;

std::size_t KdTree2D::size() const {
  return m_impl->data.points.size();
}
const Eigen::Vector2d& KdTree2D::point(std::size_t index) const {
  return m_impl->data.points[index];
}

PointHit KdTree2D::nearest(double x, double y, double radius) const {
  if (size() == 0 || !std::isfinite(x) || !std::isfinite(y) || !(radius > 0)) return {};
  NearestResult result(radius * radius);
  const double query[2] = {x, y};
  m_impl->tree.findNeighbors(result, query, {});
  return result.hit();
}

void KdTree2D::within(double x, double y, double radius, std::vector<PointHit>& out) const {
  withinUnlessMore(x, y, radius, size(), out);
}

bool KdTree2D::withinUnlessMore(double x, double y, double radius, std::size_t most,
                                std::vector<PointHit>& out) const {
  out.clear();
  if (size() == 0 || !std::isfinite(x) || !std::isfinite(y) || !(radius > 0)) return true;
  WithinResult result(radius * radius, most, out);
  const double query[2] = {x, y};
  m_impl->tree.findNeighbors(result, query, {});
  if (result.isTooMuch()) return false;
  std::sort(out.begin(), out.end(),
            [](const PointHit& a, const PointHit& b) { return a.index < b.index; });
  return true;
}

}  // namespace polemcl
