#include "map/CoordinateSystem.h"

#include <proj.h>

#include <cmath>

#include <polemcl/core/common/Types.h>
#include "io/file/TextFile.h"

namespace polemcl::apps {

struct CoordinateSystem::Impl {
  PJ_CONTEXT* context = proj_context_create();
  PJ* toLonLat = nullptr;
  ~Impl() {
    proj_destroy(toLonLat);
    proj_context_destroy(context);
  }
};

CoordinateSystem::CoordinateSystem(const std::string& name)
    : m_name(name), m_impl(std::make_unique<Impl>()) {
  proj_log_level(m_impl->context, PJ_LOG_NONE);
  PJ* raw = proj_create_crs_to_crs(m_impl->context, name.c_str(), "EPSG:4326", nullptr);
  if (raw) m_impl->toLonLat = proj_normalize_for_visualization(m_impl->context, raw);
  proj_destroy(raw);
  if (!m_impl->toLonLat)
    throw Error("unknown coordinate system '" + name + "'; allowed: names of PROJ, as EPSG:25833");
}

CoordinateSystem::~CoordinateSystem() = default;

Eigen::Vector2d CoordinateSystem::lonLat(const Eigen::Vector2d& place) const {
  const PJ_COORD found =
      proj_trans(m_impl->toLonLat, PJ_FWD, proj_coord(place.x(), place.y(), 0, 0));
  if (!(std::abs(found.lp.lam) <= 360 && std::abs(found.lp.phi) <= 90))
    throw Error("the place " + io::significant(place.x(), 9) + ' ' + io::significant(place.y(), 9) +
                " is not in the coordinate system " + m_name +
                (std::abs(place.x()) <= 90 && std::abs(place.y()) <= 360
                     ? "; are longitude and latitude swapped?"
                     : "") +
                "; --crs names another, --columns the order east, north");
  return {found.lp.lam, found.lp.phi};
}

}  // namespace polemcl::apps
