#include "cli/MapPlane.h"

#include <proj.h>

#include <cmath>

#include <polemcl/core/common/Types.h>
#include "io/file/TextFile.h"

namespace polemcl {
namespace {

constexpr double kFarthest = 1e5;  ///< m: a map is no continent

}  // namespace

struct MapPlane::Projection {
  PJ_CONTEXT* context = proj_context_create();
  PJ* toPlane = nullptr;  ///< from degrees and height to east, north, up
  ~Projection() {
    proj_destroy(toPlane);
    proj_context_destroy(context);
  }
};

MapPlane::MapPlane(const io::Datum& datum)
    : m_datum(datum),
      m_turn(datum.yawDeg * M_PI / 180),
      m_projection(std::make_unique<Projection>()) {
  const std::string pipeline =
      "+proj=pipeline +ellps=WGS84 +step +proj=unitconvert +xy_in=deg +xy_out=rad"
      " +step +proj=cart +step +proj=topocentric +lon_0=" +
      io::fixed(datum.longitude, 15) + " +lat_0=" + io::fixed(datum.latitude, 15);
  m_projection->toPlane = proj_create(m_projection->context, pipeline.c_str());
  if (!m_projection->toPlane) throw Error("datum " + io::datumText(datum) + ": PROJ cannot use it");
}

MapPlane::~MapPlane() = default;

Eigen::Vector3d MapPlane::eastNorthUp(const Eigen::Vector2d& lonLat, double height) const {
  const PJ_COORD found =
      proj_trans(m_projection->toPlane, PJ_FWD, proj_coord(lonLat.x(), lonLat.y(), height, 0));
  return {found.enu.e, found.enu.n, found.enu.u};
}

void MapPlane::requireNear(double distance) const {
  if (!(distance < kFarthest))
    throw Error("a pole " + io::fixed(distance / 1000, 0) + " km from the datum " +
                io::datumText(m_datum) + " is not on the same map");
}

Eigen::Vector2d MapPlane::lonLat(const Eigen::Vector2d& place) const {
  requireNear(place.norm());
  const Eigen::Vector2d at = m_turn * place;
  const PJ_COORD found =
      proj_trans(m_projection->toPlane, PJ_INV, proj_coord(at.x(), at.y(), 0, 0));
  return {found.lp.lam, found.lp.phi};
}

double MapPlane::distanceTo(const Eigen::Vector2d& lonLat) const {
  return eastNorthUp(lonLat, 0).norm();
}

Eigen::Vector2d MapPlane::place(const Eigen::Vector2d& lonLat) const {
  const Eigen::Vector3d ground = eastNorthUp(lonLat, 0);
  const double distance = ground.norm();
  if (!(distance <= kFarthest) && eastNorthUp({lonLat.y(), lonLat.x()}, 0).norm() <= kFarthest)
    throw Error("longitude " + io::significant(lonLat.x(), 9) + ", latitude " +
                io::significant(lonLat.y(), 9) + " is far from the datum " +
                io::datumText(m_datum) +
                ", but near it with the two swapped: longitude comes first");
  requireNear(distance);
  const Eigen::Vector3d vertical = eastNorthUp(lonLat, 1000) - ground;
  const Eigen::Vector3d onPlane = ground - vertical * (ground.z() / vertical.z());
  return m_turn.inverse() * Eigen::Vector2d(onPlane.head<2>());
}

}  // namespace polemcl
