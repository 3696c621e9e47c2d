#pragma once
/// \file Terrain.h
/// \brief The ground: slopes, undulation, and roads below kerb level.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sim/world/Detour.h"
#include "sim/world/Street.h"

namespace polemcl::sim {

/// \brief A straight road from a to b that leaves the main street.
struct SideRoad {
  Eigen::Vector2d a, b;
  double halfWidth = 3;  ///< m
};

/// \brief Ground height over the plane. Immutable once built, safe to share.
class Terrain {
 public:
  Terrain(const WorldOptions& options, const Street& street, const std::vector<SideRoad>& sideRoads,
          const std::vector<Detour>& detours = {});

  /// \brief Height of the ground, m, map frame.
  double height(double x, double y) const {
    const Sample s = sample(x, y);
    return s.base + (s.edge > 0 ? kerbHeight() : 0.0);
  }
  /// \brief Signed distance to the kerb, m: negative on the road; limited to a few metres.
  double edge(double x, double y) const { return sample(x, y).edge; }
  static constexpr double kerbHeight() { return 0.12; }

  /// \brief Hit of a ray: range along `direction` (unit) from `origin`, m; infinity if there is no
  /// hit within `maxRange`. `kerbFace` is true for a hit on the side of a kerb.
  struct Hit {
    double range;
    bool kerbFace;
    double edge;  ///< signed distance to the kerb at the hit, m
  };
  Hit intersect(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                double maxRange) const;

 private:
  struct Sample {
    double base;  ///< height of the road surface, m
    double edge;
  };
  struct Tile {
    std::vector<float> base, edge;
  };
  Sample sample(double x, double y) const;
  double smooth(double x, double y) const;
  double solve(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double lift,
               double start, double maxRange) const;
  void allocate(const std::vector<const Street*>& streets);
  void allocate(const Eigen::Vector2d& place);
  void paintRoad(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double halfWidth);
  void fillHeights();

  struct Wave {
    double amplitude, kx, ky, phase;
  };
  std::vector<Wave> m_waves;
  std::uint64_t m_seed;
  double m_relief;
  Eigen::Vector2d m_origin;  ///< lower corner of tile (0, 0)
  int m_tilesX = 0, m_tilesY = 0;
  std::vector<std::int32_t> m_tileOf;
  std::vector<Tile> m_tiles;
};

}  // namespace polemcl::sim
