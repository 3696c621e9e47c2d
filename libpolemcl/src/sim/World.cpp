#include <polemcl/sim/World.h>

#include <algorithm>
#include <cmath>

#include "StreetPlan.h"

namespace polemcl::sim {
namespace {
constexpr double kCell = 10;  // of the index of objects, m
}

World::World(const WorldOptions& options, Street street, Terrain terrain,
             std::vector<WorldObject> objects, std::vector<TruePole> poles)
    : m_options(options),
      m_street(std::move(street)),
      m_terrain(std::move(terrain)),
      m_objects(std::move(objects)),
      m_poles(std::move(poles)) {
  Eigen::Vector2d low(0, 0), high(0, 0);
  for (std::size_t i = 0; i < m_objects.size(); ++i) {
    low = i == 0 ? m_objects[i].centre : low.cwiseMin(m_objects[i].centre).eval();
    high = i == 0 ? m_objects[i].centre : high.cwiseMax(m_objects[i].centre).eval();
  }
  m_gridOrigin = low;
  m_gridX = static_cast<int>((high.x() - low.x()) / kCell) + 1;
  m_gridY = static_cast<int>((high.y() - low.y()) / kCell) + 1;
  m_grid.resize(static_cast<std::size_t>(m_gridX) * m_gridY);
  for (std::size_t i = 0; i < m_objects.size(); ++i) {
    const Eigen::Vector2d cell = (m_objects[i].centre - low) / kCell;
    m_grid[static_cast<std::size_t>(cell.y()) * m_gridX + static_cast<std::size_t>(cell.x())]
        .push_back(static_cast<std::uint32_t>(i));
    m_largest = std::max(m_largest, m_objects[i].radius + m_objects[i].walk.norm());
  }
}

std::vector<std::uint32_t> World::objectsWithin(double x, double y, double radius) const {
  std::vector<std::uint32_t> found;
  const double reach = radius + m_largest;
  const auto cell = [](double offset, int count) {
    return std::clamp(static_cast<int>(std::floor(offset / kCell)), 0, count - 1);
  };
  const int x0 = cell(x - reach - m_gridOrigin.x(), m_gridX),
            x1 = cell(x + reach - m_gridOrigin.x(), m_gridX);
  const int y0 = cell(y - reach - m_gridOrigin.y(), m_gridY),
            y1 = cell(y + reach - m_gridOrigin.y(), m_gridY);
  for (int row = y0; row <= y1; ++row)
    for (int column = x0; column <= x1; ++column)
      for (const std::uint32_t i : m_grid[static_cast<std::size_t>(row) * m_gridX + column]) {
        const WorldObject& object = m_objects[i];
        const double limit = radius + object.radius + object.walk.norm();
        if ((object.centre - Eigen::Vector2d(x, y)).squaredNorm() <= limit * limit)
          found.push_back(i);
      }
  std::sort(found.begin(), found.end());
  return found;
}

World makeWorld(const WorldOptions& options) {
  options.validate();
  Street street = Street::make(options);
  const auto crossings = planCrossings(options, street);
  Terrain terrain(options, street, sideRoads(crossings, street, options));
  StreetPlan plan(options, street, terrain, crossings);
  plan.furnish();
  return World(options, std::move(street), std::move(terrain), std::move(plan.objects),
               std::move(plan.poles));
}

}  // namespace polemcl::sim
