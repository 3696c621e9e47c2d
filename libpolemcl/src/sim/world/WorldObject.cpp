#include "sim/world/WorldObject.h"

#include <Eigen/Geometry>
#include <cmath>

#include "sim/common/Random.h"

namespace polemcl::sim {

const char* name(Kind kind) {
  static const char* const names[] = {
      "lamp post", "sign",       "traffic light", "tree",    "bush",    "hedge",
      "house",     "wall",       "car",           "person",  "bicycle", "fence",
      "bollard",   "billboard",  "bin",           "cabinet", "column",  "snow bank",
      "hoarding",  "site fence", "container",     "beacon"};
  return names[static_cast<int>(kind)];
}

Eigen::Matrix3d axesAlong(const Eigen::Vector3d& direction) {
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), direction).toRotationMatrix();
}

ObjectBuilder::ObjectBuilder(Kind kind, const Site& site) : m_base(site.base) {
  m_object.kind = kind;
  m_turn = Eigen::AngleAxisd(site.heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

Solid ObjectBuilder::placed(Shape shape, const Eigen::Vector3d& centre, const Eigen::Vector3d& size,
                            const Material& material, double yaw) const {
  Solid solid;
  solid.shape = shape;
  solid.position = m_base + m_turn * centre;
  solid.axes = m_turn * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  solid.size = size;
  solid.material = material;
  solid.object = m_crown ? kFoliageBit : 0;
  return solid;
}

void ObjectBuilder::post(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radiusA,
                         double radiusB, const Material& material) {
  const Eigen::Vector3d along = b - a;
  Solid solid =
      placed(Shape::frustum, a, Eigen::Vector3d(radiusA, radiusB, along.norm()), material, 0);
  solid.axes = m_turn * axesAlong(along);
  m_object.solids.push_back(solid);
}

void ObjectBuilder::box(const Eigen::Vector3d& centre, const Eigen::Vector3d& half,
                        const Material& material, double yaw) {
  m_object.solids.push_back(placed(Shape::box, centre, half, material, yaw));
}

void ObjectBuilder::ellipsoid(const Eigen::Vector3d& centre, const Eigen::Vector3d& half,
                              const Material& material, double density, double yaw) {
  m_object.solids.push_back(placed(Shape::ellipsoid, centre, half, material, yaw));
  m_object.solids.back().density = static_cast<float>(density);
}

void ObjectBuilder::thicket(const Eigen::Vector3d& centre, const Eigen::Vector3d& half,
                            const Material& material, double density, double yaw) {
  m_object.solids.push_back(placed(Shape::thicket, centre, half, material, yaw));
  m_object.solids.back().density = static_cast<float>(density);
}

namespace {
/// \brief Radius of a circle around the solid's position that contains it, seen from above, m.
double reach(const Solid& solid) {
  if (solid.shape == Shape::frustum)
    return solid.size.z() * solid.axes.col(2).head<2>().norm() +
           std::max(solid.size.x(), solid.size.y());
  double square = 0;
  for (int i = 0; i < 3; ++i)
    square += std::pow(solid.size[i], 2) * solid.axes.col(i).head<2>().squaredNorm();
  return std::sqrt(square) * (solid.shape == Shape::ellipsoid ? 1.0 : 1.4143);
}
}  // namespace

WorldObject ObjectBuilder::build(std::uint32_t id) {
  m_object.id = id;
  m_object.centre = Eigen::Vector2d::Zero();
  for (Solid& solid : m_object.solids) {
    solid.object |= id;
    m_object.centre += solid.position.head<2>() / static_cast<double>(m_object.solids.size());
  }
  m_object.radius = 0;
  for (const Solid& solid : m_object.solids)
    m_object.radius = std::max(m_object.radius,
                               (solid.position.head<2>() - m_object.centre).norm() + reach(solid));
  return m_object;
}

}  // namespace polemcl::sim
