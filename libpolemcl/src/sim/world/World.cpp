#include "sim/world/World.h"

#include <algorithm>
#include <cmath>

#include "sim/world/Season.h"
#include "sim/world/StreetLayout.h"

namespace polemcl::sim {
namespace {
constexpr double kIndexCell = 10;  // cell of the object index, m
}

World::World(const WorldOptions& options, Street street, Terrain terrain,
             std::vector<WorldObject> objects, std::vector<TruePole> poles,
             std::vector<BuildingSite> sites, std::vector<Detour> detours)
    : m_options(options),
      m_street(std::move(street)),
      m_terrain(std::move(terrain)),
      m_objects(std::move(objects)),
      m_poles(std::move(poles)),
      m_sites(std::move(sites)),
      m_detours(std::move(detours)) {
  Eigen::Vector2d low(0, 0), high(0, 0);
  for (std::size_t i = 0; i < m_objects.size(); ++i) {
    low = i == 0 ? m_objects[i].centre : low.cwiseMin(m_objects[i].centre).eval();
    high = i == 0 ? m_objects[i].centre : high.cwiseMax(m_objects[i].centre).eval();
  }
  m_gridOrigin = low;
  m_gridX = static_cast<int>((high.x() - low.x()) / kIndexCell) + 1;
  m_gridY = static_cast<int>((high.y() - low.y()) / kIndexCell) + 1;
  m_grid.resize(static_cast<std::size_t>(m_gridX) * m_gridY);
  for (std::size_t i = 0; i < m_objects.size(); ++i) {
    const Eigen::Vector2d cell = (m_objects[i].centre - low) / kIndexCell;
    m_grid[static_cast<std::size_t>(cell.y()) * m_gridX + static_cast<std::size_t>(cell.x())]
        .push_back(static_cast<std::uint32_t>(i));
    m_largest = std::max(m_largest, m_objects[i].radius);
  }
}

std::vector<std::uint32_t> World::objectsWithin(double x, double y, double radius) const {
  std::vector<std::uint32_t> found;
  const double reach = radius + m_largest;
  const auto cell = [](double offset, int count) {
    return std::clamp(static_cast<int>(std::floor(offset / kIndexCell)), 0, count - 1);
  };
  const int x0 = cell(x - reach - m_gridOrigin.x(), m_gridX),
            x1 = cell(x + reach - m_gridOrigin.x(), m_gridX);
  const int y0 = cell(y - reach - m_gridOrigin.y(), m_gridY),
            y1 = cell(y + reach - m_gridOrigin.y(), m_gridY);
  for (int row = y0; row <= y1; ++row)
    for (int column = x0; column <= x1; ++column)
      for (const std::uint32_t i : m_grid[static_cast<std::size_t>(row) * m_gridX + column]) {
        const WorldObject& object = m_objects[i];
        const double limit = radius + object.radius;
        if ((object.centre - Eigen::Vector2d(x, y)).squaredNorm() <= limit * limit)
          found.push_back(i);
      }
  std::sort(found.begin(), found.end());
  return found;
}

double World::snowAt(double x, double y) const {
  double top = 0;
  for (const std::uint32_t i : objectsWithin(x, y, 0)) {
    if (m_objects[i].kind != Kind::snowBank) continue;
    for (const Solid& heap : m_objects[i].solids) {
      const Eigen::Vector3d offset(x - heap.position.x(), y - heap.position.y(), 0);
      const Eigen::Vector3d local = (heap.axes.transpose() * offset).cwiseQuotient(heap.size);
      const double rest = 1 - local.head<2>().squaredNorm();
      if (rest <= 0) continue;
      const double height = heap.position.z() + heap.size.z() * std::sqrt(rest);
      top = std::max(top, height - m_terrain.height(x, y));
    }
  }
  return top;
}

namespace {
/// \brief The objects of all streets.
struct Furnished {
  std::vector<WorldObject> objects;
  std::vector<TruePole> poles;
  std::vector<BuildingSite> sites;
  void add(StreetLayout plan) {
    objects.insert(objects.end(), plan.objects.begin(), plan.objects.end());
    poles.insert(poles.end(), plan.poles.begin(), plan.poles.end());
    sites.insert(sites.end(), plan.sites.begin(), plan.sites.end());
  }
};

Furnished furnish(const WorldOptions& options, const Street& street, const Terrain& terrain,
                  const std::vector<Crossing>& crossings, const std::vector<Detour>& detours) {
  WorldOptions today = options;
  if (options.dayOfYear > 0) today.foliage *= seasonOf(options.dayOfYear + options.day).foliage;
  Furnished all;
  StreetLayout plan(today, street, terrain, crossings);
  plan.furnish();
  all.add(std::move(plan));
  for (std::size_t k = 0; k < detours.size(); ++k) {
    WorldOptions own = today;
    own.seed = hash(options.seed, 0x51de2ull, k);
    std::vector<Crossing> bends;  // no wide objects in bends
    for (const double s : detours[k].bends) bends.push_back({s, true, true, 12, false});
    StreetLayout sidePlan(own, detours[k].street, terrain, bends,
                          static_cast<std::uint32_t>(k + 1));
    sidePlan.furnish();
    all.add(std::move(sidePlan));
  }
  if (!detours.empty()) removeBuiltOver(all.objects, all.poles);
  return all;
}
}  // namespace

World makeWorld(const WorldOptions& options) {
  options.validate();
  Street street = Street::make(options);
  auto detours = planDetours(options, street);
  const auto crossings = planCrossings(options, street, detours);
  Terrain terrain(options, street, sideRoads(crossings, street, options), detours);
  Furnished all = furnish(options, street, terrain, crossings, detours);
  return World(options, std::move(street), std::move(terrain), std::move(all.objects),
               std::move(all.poles), std::move(all.sites), std::move(detours));
}

}  // namespace polemcl::sim
