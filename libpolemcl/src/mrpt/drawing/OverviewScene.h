#pragma once
/// \file OverviewScene.h
/// \brief A map and paths on it as a scene that viewers open on all of it.

#include <functional>

#include "mrpt/drawing/SceneParts.h"

namespace polemcl {

/// \brief Collects the objects of a scene; takes the map frame, m.
///
/// All lies in the object `map` of viewport `main`, in metres about the scene's origin, which the
/// legend (viewport `text`) names when it is not that of the map. `map` is drawn at 1:1, 1:10, … so
/// that it is at most 20 units long: viewers draw nothing beyond 10000 units, and at a thousand
/// they cannot tell which of two things is nearer. The scene asks viewers to take its camera, which
/// shows everything: long streets from one end, other places from the south.
class OverviewScene {
 public:
  /// \param places_map All that has to be seen, m; finite.
  OverviewScene(const scene::Path& places_map, const std::string& title);

  /// \brief Cylinders true to scale, and a dot on each, `<name> dots`, that is seen from afar.
  void addPoles(const std::string& name, const std::vector<MapPole>& poles,
                const std::function<scene::TColor(const MapPole&)>& color);
  /// \brief `bothSides`: two strips, with room for another ribbon between them. From afar viewers
  /// could not tell which of two ribbons lies on top.
  struct Ribbon {
    scene::TColor color;
    bool bothSides = false;
    double width = 0;  ///< m; 0: as the size of the scene asks for, at least 1 m
  };
  /// \brief A ribbon along each path, with gaps where two places are more than 50 m apart.
  void addRibbons(const std::string& name, const std::vector<scene::Path>& paths_map,
                  const Ribbon& ribbon);
  void addLegend(const std::vector<scene::LegendLine>& lines);
  /// \brief The scene with ground, legend and camera. To be called once.
  mrpt::opengl::COpenGLScene::Ptr finish();

 private:
  double addGround();  ///< with the coordinates of its corners; returns the step of its grid, m

  scene::Path m_places;  ///< in the scene's frame, m
  Eigen::AlignedBox2d m_box;
  Eigen::Vector2d m_origin;  ///< of the scene, map frame, m
  double m_extent = 0;       ///< the longer side of the box, m
  double m_unit = 1;         ///< a viewer's unit, m
  std::vector<scene::LegendLine> m_legend;
  mrpt::opengl::COpenGLScene::Ptr m_scene;
  mrpt::opengl::CSetOfObjects::Ptr m_content;
};

}  // namespace polemcl
