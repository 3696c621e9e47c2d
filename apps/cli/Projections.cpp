#include "cli/Projections.h"

#include <proj.h>

#include <cmath>

#include <polemcl/core/common/Types.h>
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

constexpr double kFarthest = 1e5;  ///< m: a map is no continent

}  // namespace

struct Projection {
  PJ_CONTEXT* context = proj_context_create();
  PJ* steps = nullptr;  ///< none when PROJ cannot use what was asked for
  ~Projection() {
    proj_destroy(steps);
    proj_context_destroy(context);
  }
  PJ_COORD apply(PJ_DIRECTION direction, double x, double y, double z = 0) const {
    return proj_trans(steps, direction, proj_coord(x, y, z, 0));
  }
};

CoordinateSystem::CoordinateSystem(const std::string& name)
    : m_name(name), m_toLonLat(std::make_shared<Projection>()) {
  proj_log_level(m_toLonLat->context, PJ_LOG_NONE);
  PJ* raw = proj_create_crs_to_crs(m_toLonLat->context, name.c_str(), "EPSG:4326", nullptr);
  if (raw) m_toLonLat->steps = proj_normalize_for_visualization(m_toLonLat->context, raw);
  proj_destroy(raw);
  if (!m_toLonLat->steps)
    throw Error("unknown coordinate system '" + name + "'; allowed: names of PROJ, as EPSG:25833");
}

Eigen::Vector2d CoordinateSystem::lonLat(const Eigen::Vector2d& place) const {
  const PJ_COORD found = m_toLonLat->apply(PJ_FWD, place.x(), place.y());
  if (!(std::abs(found.lp.lam) <= 360 && std::abs(found.lp.phi) <= 90))
    throw Error("the place " + io::significant(place.x(), 9) + ' ' + io::significant(place.y(), 9) +
                " is not in the coordinate system " + m_name +
                (std::abs(place.x()) <= 90 && std::abs(place.y()) <= 360
                     ? "; are longitude and latitude swapped?"
                     : "") +
                "; --crs names another, --columns the order east, north");
  return {found.lp.lam, found.lp.phi};
}

MapPlane::MapPlane(const io::Datum& datum)
    : m_datum(datum), m_turn(datum.yawDeg * M_PI / 180), m_toPlane(std::make_shared<Projection>()) {
  const std::string pipeline =
      "+proj=pipeline +ellps=WGS84 +step +proj=unitconvert +xy_in=deg +xy_out=rad"
      " +step +proj=cart +step +proj=topocentric +lon_0=" +
      io::fixed(datum.longitude, 15) + " +lat_0=" + io::fixed(datum.latitude, 15);
  m_toPlane->steps = proj_create(m_toPlane->context, pipeline.c_str());
  if (!m_toPlane->steps) throw Error("datum " + io::datumText(datum) + ": PROJ cannot use it");
}

Eigen::Vector3d MapPlane::eastNorthUp(const Eigen::Vector2d& lonLat, double height) const {
  const PJ_COORD found = m_toPlane->apply(PJ_FWD, lonLat.x(), lonLat.y(), height);
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
  const PJ_COORD found = m_toPlane->apply(PJ_INV, at.x(), at.y());
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

}  // namespace polemcl::apps
