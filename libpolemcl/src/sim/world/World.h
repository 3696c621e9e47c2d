#pragma once
/// \file World.h
/// \brief The street, its ground and all objects on one day.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sim/common/SimulationOptions.h"
#include "sim/world/Detour.h"
#include "sim/world/Street.h"
#include "sim/world/Terrain.h"
#include "sim/world/WorldObject.h"

namespace polemcl::sim {

/// \brief A building site beside a street. It exists on days d with firstDay <= d < endDay.
struct BuildingSite {
  std::uint64_t seed = 0;             ///< seed of its details; equal on all its days
  double firstDay = 0, endDay = 0;    ///< days since the day of the map; may be negative
  int side = 1;                       ///< side of its street: 1 left, -1 right
  double from = 0, to = 0;            ///< m along its street
  bool boards = false;                ///< hoarding of boards; otherwise mesh fences
  std::vector<Eigen::Vector2d> kerb;  ///< fence along the kerb, map frame, about 1 m apart
};

/// \brief A world on one day. Immutable, safe to share between threads.
class World {
 public:
  World(const WorldOptions& options, Street street, Terrain terrain,
        std::vector<WorldObject> objects, std::vector<TruePole> poles,
        std::vector<BuildingSite> sites = {}, std::vector<Detour> detours = {});

  const WorldOptions& options() const { return m_options; }
  const Street& street() const { return m_street; }
  const Terrain& terrain() const { return m_terrain; }
  const std::vector<WorldObject>& objects() const { return m_objects; }
  /// \brief The poles of this day, sorted by id.
  const std::vector<TruePole>& poles() const { return m_poles; }
  /// \brief The building sites of this day.
  const std::vector<BuildingSite>& buildingSites() const { return m_sites; }
  const std::vector<Detour>& detours() const { return m_detours; }
  /// \brief The path of a drive: the street (0), or with a detour (from 1).
  const Street& path(int detour) const {
    return detour == 0 ? m_street : m_detours.at(static_cast<std::size_t>(detour - 1)).path;
  }
  /// \brief Height of the snow bank at a place, m above ground; 0 without a bank.
  double snowAt(double x, double y) const;
  /// \brief Indices of the objects that may reach into a circle, ascending.
  std::vector<std::uint32_t> objectsWithin(double x, double y, double radius) const;

 private:
  WorldOptions m_options;
  Street m_street;
  Terrain m_terrain;
  std::vector<WorldObject> m_objects;
  std::vector<TruePole> m_poles;
  std::vector<BuildingSite> m_sites;
  std::vector<Detour> m_detours;
  Eigen::Vector2d m_gridOrigin;
  int m_gridX = 0, m_gridY = 0;
  double m_largest = 0;  ///< reach of the largest object, m
  std::vector<std::vector<std::uint32_t>> m_grid;
};

/// \brief Builds the world of (seed, day): equal numbers on any machine and number of threads.
/// \throws Error when an option is out of range or the track cannot be read.
World makeWorld(const WorldOptions& options);

}  // namespace polemcl::sim
