#pragma once
/// \file WorldObject.h
/// \brief Objects made of solids, and the builder that places them.

#include <string>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "sim/world/Solid.h"

namespace polemcl::sim {

enum class Kind : std::uint8_t {
  lampPost,
  sign,
  trafficLight,
  tree,  // poles, when tall enough
  bush,
  hedge,
  house,
  wall,
  car,
  person,
  bicycle,
  fence,
  bollard,
  billboard,
  bin,
  cabinet,
  column,
  // seasonal objects and those of some weeks
  snowBank,
  hoarding,   ///< boards
  siteFence,  ///< mesh
  container,
  beacon
};
const char* name(Kind kind);

/// Number of ids per street; the ids of the next street follow.
inline constexpr std::uint32_t kIdsPerStreet = 2000000;
/// First id within a street of objects that exist on one day only.
inline constexpr std::uint32_t kFirstIdOfOneDay = 1000000;
/// \brief True if the object with this id exists on one day only.
constexpr bool ofOneDay(std::uint32_t id) {
  return id % kIdsPerStreet >= kFirstIdOfOneDay;
}

/// \brief Height above ground at which TruePole gives position and radius, m.
constexpr double kTruthHeight = 1.5;

/// \brief A true pole: slim, vertical, its top at least 2 m above ground.
struct TruePole {
  std::uint32_t id = 0;  ///< the label of its points
  double x = 0, y = 0;   ///< axis at 1.5 m above ground, m, map frame
  double radius = 0;     ///< at 1.5 m above ground, m
  double top = 0;        ///< end of the slim part, m above ground
  Kind kind = Kind::lampPost;
};

/// \brief Position of an object: local x along the street, local y away from the road.
struct Site {
  Eigen::Vector3d base = Eigen::Vector3d::Zero();  ///< on the ground, map frame
  double heading = 0;                              ///< direction of local x, rad
};

/// \brief One object. Its solids are in the map frame.
struct WorldObject {
  std::uint32_t id = 0;
  Kind kind = Kind::house;
  std::vector<Solid> solids;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< centre of the bounding circle, m
  double radius = 0;                                 ///< of the bounding circle, m
};

/// \brief Axes of a solid, as columns, whose z points along a direction of any length above 0.
Eigen::Matrix3d axesAlong(const Eigen::Vector3d& direction);

/// \brief Collects solids given in the frame of a site.
class ObjectBuilder {
 public:
  ObjectBuilder(Kind kind, const Site& site);
  /// \brief Post from a to b with the radii at its ends.
  void post(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radiusA, double radiusB,
            const Material& material);
  /// \brief Box with half extents, rotated by yaw about local z.
  void box(const Eigen::Vector3d& centre, const Eigen::Vector3d& half, const Material& material,
           double yaw = 0);
  void ellipsoid(const Eigen::Vector3d& centre, const Eigen::Vector3d& half,
                 const Material& material, double density = 0, double yaw = 0);
  void thicket(const Eigen::Vector3d& centre, const Eigen::Vector3d& half, const Material& material,
               double density, double yaw = 0);
  /// \brief The following solids are crown: their points are labelled with kFoliageBit.
  void startCrown() { m_crown = true; }
  /// \brief Finishes the object: bounding circle and ids.
  WorldObject build(std::uint32_t id);

 private:
  Solid placed(Shape shape, const Eigen::Vector3d& centre, const Eigen::Vector3d& size,
               const Material& material, double yaw) const;
  WorldObject m_object;
  bool m_crown = false;
  Eigen::Matrix3d m_turn;
  Eigen::Vector3d m_base;
};

}  // namespace polemcl::sim
