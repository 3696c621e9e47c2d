#pragma once
/// \file Solid.h
/// \brief Shapes of the world, and their effect on a laser pulse.

#include <Eigen/Core>
#include <cstdint>

namespace polemcl::sim {

/// \brief Effect of a surface on a pulse.
struct Material {
  float reflectivity = 0.3f;  ///< diffuse, at 905 nm; above 1: retro-reflecting
  float roughness = 0.0f;     ///< standard deviation of the surface, m
  float passes = 0.0f;        ///< probability that a pulse passes (glass, mesh)
};

namespace materials {
constexpr Material kAsphalt{0.15f, 0.004f, 0}, kPaving{0.25f, 0.006f, 0}, kGrass{0.45f, 0.025f, 0},
    kMetal{0.35f, 0.001f, 0}, kDarkMetal{0.12f, 0.001f, 0}, kSignFace{2.5f, 0.001f, 0},
    kBark{0.28f, 0.008f, 0}, kLeaves{0.45f, 0.01f, 0}, kPlaster{0.4f, 0.004f, 0},
    kBrick{0.25f, 0.006f, 0}, kWood{0.3f, 0.004f, 0}, kConcrete{0.3f, 0.004f, 0},
    kCloth{0.25f, 0.012f, 0}, kSkin{0.45f, 0.003f, 0}, kRubber{0.05f, 0.004f, 0},
    kCarGlass{0.06f, 0.001f, 0.75f}, kHouseGlass{0.004f, 0.001f, 0}, kPlastic{0.2f, 0.002f, 0},
    kSnow{0.8f, 0.02f, 0};
}

enum class Shape : std::uint8_t {
  frustum,    ///< vertical or tilted post: cone between two radii, with caps
  box,        ///< oriented box
  ellipsoid,  ///< solid, or porous when `density` > 0
  thicket     ///< porous oriented box (hedge, mesh)
};

/// \brief Set in the label of points on branches and leaves. Points on the trunk have the plain id.
constexpr std::uint32_t kFoliageBit = 0x80000000u;

/// \brief One shape, in the map frame. Units m.
struct Solid {
  Shape shape = Shape::box;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< centre; frustum: centre of its base
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: own axes; frustum: z along it
  /// Half extents (box, thicket), half axes (ellipsoid); frustum: radius at base, radius at end,
  /// length.
  Eigen::Vector3d size = Eigen::Vector3d::Ones();
  /// Porous shapes: share of leaf cells that are filled, in (0, 1]; 0 for solid ones.
  float density = 0;
  float cell = 0.12f;  ///< edge of a leaf cell, m
  Material material;
  std::uint32_t object = 0;  ///< label of its points: id of the object, kFoliageBit for a crown
};

}  // namespace polemcl::sim
