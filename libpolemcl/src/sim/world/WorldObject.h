#pragma once
/// \file WorldObject.h
/// \brief Things made of solids, and the builder that places them.

#include <string>
#include <vector>

#include "core/common/Types.h"
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
  // of a season or for some weeks
  snowBank,
  hoarding,   ///< boards
  siteFence,  ///< mesh
  container,
  beacon
};
const char* name(Kind kind);

/// Ids of the things of one street; those of the next begin there.
inline constexpr std::uint32_t kIdsPerStreet = 2000000;
/// Where ids of a street begin that mean another thing on another day.
inline constexpr std::uint32_t kFirstIdOfOneDay = 1000000;
/// \brief True when the thing of this id stands on one day only.
constexpr bool ofOneDay(std::uint32_t id) {
  return id % kIdsPerStreet >= kFirstIdOfOneDay;
}

/// \brief A true pole: slim, upright, its top at least 2 m above ground.
struct TruePole {
  std::uint32_t id = 0;  ///< the label of its points
  double x = 0, y = 0;   ///< axis at 1.5 m above ground, m, map frame
  double radius = 0;     ///< there, m
  double top = 0;        ///< of the slim part, m above ground
  Kind kind = Kind::lampPost;
};

/// \brief Where an object stands: local x along the street, local y away from the road.
struct Site {
  Eigen::Vector3d base = Eigen::Vector3d::Zero();  ///< on the ground, map frame
  double heading = 0;                              ///< of local x, rad
};

/// \brief One thing. Its solids are in the map frame at time 0.
struct WorldObject {
  std::uint32_t id = 0;
  Kind kind = Kind::house;
  std::vector<Solid> solids;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< of the bounding circle, m
  double radius = 0;                                 ///< of the bounding circle, m
  Eigen::Vector2d walk = Eigen::Vector2d::Zero();    ///< it walks to centre + walk and back, m
  double pace = 0;                                   ///< m/s; 0: it stands
  /// \brief Displacement at a time, m.
  Eigen::Vector2d displacement(double time) const;
};

/// \brief Collects solids given in the frame of a site.
class ObjectBuilder {
 public:
  ObjectBuilder(Kind kind, const Site& site);
  /// \brief Post from a to b with radii there.
  void post(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radiusA, double radiusB,
            const Material& material);
  /// \brief Box with half extents, turned by yaw about local z.
  void box(const Eigen::Vector3d& centre, const Eigen::Vector3d& half, const Material& material,
           double yaw = 0);
  void ellipsoid(const Eigen::Vector3d& centre, const Eigen::Vector3d& half,
                 const Material& material, double density = 0, double yaw = 0);
  void thicket(const Eigen::Vector3d& centre, const Eigen::Vector3d& half, const Material& material,
               double density, double yaw = 0);
  /// \brief What follows is crown: its points are labelled with kFoliageBit.
  void startCrown() { m_crown = true; }
  /// \brief Finishes: bounding circle and ids.
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
