#pragma once
/// \file SightLines.h
/// \brief Tests whether an obstacle stands between two places, seen from above.

#include <Eigen/Core>
#include <vector>

#include "sim/world/World.h"

namespace polemcl::sim {

/// \brief Kind of an obstacle.
enum class Obstacle {
  opaque,  ///< houses, walls, hoardings, containers
  mesh     ///< fences of building sites; some pulses pass
};

/// \brief All obstacles of one kind in a world, as rectangles. Immutable, safe to share.
class SightLines {
 public:
  explicit SightLines(const World& world, Obstacle obstacle = Obstacle::opaque);

  /// \brief A rectangle: local = axes (p - centre), inside when |local| <= half.
  struct Block {
    Eigen::Vector2d centre, half;
    Eigen::Matrix2d axes;
    double reach = 0;  ///< distance of its corners from the centre, m
  };
  /// \brief The blocks that reach into a circle.
  std::vector<const Block*> around(const Eigen::Vector2d& place, double radius) const;
  /// \brief Whether a block crosses the line between two places.
  static bool blocked(const std::vector<const Block*>& blocks, const Eigen::Vector2d& from,
                      const Eigen::Vector2d& to);
  /// \brief Distance from a place to the first block on the line to another place, m; the whole
  /// distance if no block crosses it.
  static double freeWay(const std::vector<const Block*>& blocks, const Eigen::Vector2d& from,
                        const Eigen::Vector2d& to);

 private:
  std::vector<Block> m_blocks;
};

}  // namespace polemcl::sim
