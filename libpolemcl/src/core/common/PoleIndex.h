#pragma once
/// \file PoleIndex.h
/// \brief Nearest pole within a radius: a grid of candidates, and nanoflann beyond its reach.
///
/// Both are exact and give the same pole. nearest() and the likelihood (PoleLikelihood.h) ask the
/// grid up to preparedRadius() and nanoflann's tree beyond it; within() always asks the tree.
/// CPoleMap prepares for the gate of its likelihood, so the particle filter asks the grid only.
/// Built eagerly and never changed, so it is safe to share between threads.

#include <memory>
#include <optional>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>

namespace polemcl {

class KdTree2D;
class PoleGrid;

class POLEMCL_EXPORT PoleIndex {
 public:
  /// Greatest coordinate of a pole, m. One pole far off would make all others share one cell.
  static constexpr double farthest = 1e9;

  struct Neighbour {
    std::size_t index;  ///< into the poles given to the constructor
    double distance;    ///< m
  };
  /// \param poles Copied in part; may be empty.
  /// \param preparedRadius Searches up to it take one look-up in the grid, wider ones a search of
  ///        nanoflann's tree, m. Give the gate of the likelihood. Memory grows with the poles, not
  ///        with the area.
  /// \throws Error on a pole that lies beyond `farthest` or whose centre or covariance is not
  ///         finite; also on a radius that is not finite and positive.
  explicit PoleIndex(const std::vector<MapPole>& poles, double preparedRadius = 1.0);

  std::size_t size() const { return m_variances.size(); }
  double preparedRadius() const { return m_preparedRadius; }
  /// \brief The nearest pole with distance < radius, if any. The lower index wins a tie.
  /// "<" is decided on the squares. A query that is not a number finds nothing.
  std::optional<Neighbour> nearest(double x, double y, double radius) const;
  /// \brief All poles with distance < radius, sorted by distance then index.
  std::vector<Neighbour> within(double x, double y, double radius) const;

  /// \name The parts, for loops that ask thousands of times
  /// @{
  const PoleGrid& grid() const { return *m_grid; }
  const KdTree2D& tree() const { return *m_tree; }
  /// \brief Half the trace of a pole's covariance: its mean variance along an axis, m².
  double variance(std::size_t pole) const { return m_variances[pole]; }
  /// @}

 private:
  std::shared_ptr<const KdTree2D> m_tree;  ///< never changed, so copies share it
  std::shared_ptr<const PoleGrid> m_grid;  ///< as m_tree
  double m_preparedRadius;
  std::vector<double> m_variances;
};

}  // namespace polemcl
