#pragma once
/// \file OverviewScene.h
/// \brief A map and paths on it as a scene; viewers open it with everything in view.

#include <functional>

#include "mrpt/drawing/SceneParts.h"

namespace polemcl {

/// \brief Collects the objects of a scene. Input: map frame, m.
///
/// All content is in the object `map` of viewport `main`, in metres from the scene's origin. If
/// this is not the map's origin, the legend (viewport `text`) states it. `map` is drawn at 1:1,
/// 1:10, … so that it is at most 20 units long: viewers draw nothing beyond 10000 units, and at a
/// thousand units their depth buffer is too coarse. The scene makes viewers use its camera, which
/// shows everything: long streets from one end, other places from the south.
class OverviewScene {
 public:
  /// \param places_map All positions that must be visible, m; finite.
  OverviewScene(const scene::Path& places_map, const std::string& title);

  /// \brief Cylinders true to scale, and a dot on each (`<name> dots`) that is visible from far
  /// away.
  void addPoles(const std::string& name, const std::vector<MapPole>& poles,
                const std::function<scene::TColor(const MapPole&)>& color);
  /// \brief With `bothSides`, two strips with room for another ribbon between them. From far away,
  /// viewers cannot tell which of two stacked ribbons is on top.
  struct Ribbon {
    scene::TColor color;
    bool bothSides = false;
    double width = 0;    ///< m; 0: chosen by the size of the scene, at least 1 m
    bool above = false;  ///< over the other ribbons
  };
  /// \brief A ribbon along each path, with gaps where two positions are more than 50 m apart.
  void addRibbons(const std::string& name, const std::vector<scene::Path>& paths_map,
                  const Ribbon& ribbon);
  void addLegend(const std::vector<scene::LegendLine>& lines);
  /// \brief The scene with ground, legend and camera. Call it once.
  viz::Scene::Ptr finish();

 private:
  double addGround();  ///< grid with labelled corners; returns its step, m

  scene::Path m_places;  ///< in the scene's frame, m
  Eigen::AlignedBox2d m_box;
  Eigen::Vector2d m_origin;  ///< of the scene, map frame, m
  double m_extent = 0;       ///< the longer side of the box, m
  double m_unit = 1;         ///< length of a viewer's unit, m
  std::vector<scene::LegendLine> m_legend;
  viz::Scene::Ptr m_scene;
  viz::CSetOfObjects::Ptr m_content;
};

}  // namespace polemcl
