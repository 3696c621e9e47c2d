#pragma once
/// \file LiveScene.h
/// \brief A running localization as a 3D scene of stock MRPT objects, moment by moment.

#include <string>
#include <vector>

#include <polemcl/mrpt/common/Compatibility.h>
#include "report/scene/LiveMoment.h"

namespace polemcl::report {

/// \brief What the window shows, what frames are rendered from and what `.3Dscene` files hold.
///
/// Viewport `main`, map frame, ground at z = 0, with the objects
/// - `ground`: a grid; `map`: a cylinder per map pole;
/// - `way`: where the estimate has been; `vehicle`: an arrow at the estimate; coloured by health;
/// - `true_way`, `true_vehicle`: the same of the truth; `points`: those of the scan;
/// - `ellipse`: 95 % of the estimate's positions; `particles`: points, the heavier the darker;
/// - `matched`, `unmatched`: observed poles that stand on the map, or not, with lines of sight;
/// - `hypotheses`: arrows where the last search supposes the vehicle, while the pose is in doubt.
///
/// Empty objects are left out. The camera follows from behind; without a pose it shows
/// the whole map, with `dots` for the poles. Viewers of `.3Dscene` files take this camera. Viewport
/// `text`: health, matched share, spread, particles, legend. Viewport `close`, with a pose:
/// particles and ellipse from above, relative to the estimate, magnified as their spread asks for.
///
/// Far from the map's origin the scene has one of its own (scene::originFor), which the legend
/// names.
class LiveScene {
 public:
  /// \param map As drawn all the time. \param title One line, for the text. \param textScale
  /// Factor on the size of letters and points: 2 for pictures that are halved afterwards.
  /// \throws Error on a map without poles or with a coordinate that is not finite.
  LiveScene(const std::vector<MapPole>& map, std::string title, double textScale = 1);

  /// \brief Shows this moment in place of the one before. Moments must come in order of time: the
  /// camera turns with the vehicle gently, by the metres between two of them.
  void show(const LiveMoment& moment);

  const viz::Scene::Ptr& scene() const { return m_scene; }
  /// \brief That of the main viewport.
  const viz::CCamera& camera() const;

 private:
  void showText(const LiveMoment& moment);
  void showObjects(const LiveMoment& moment);
  void showClose(const LiveMoment& moment);
  void aim(const LiveMoment& moment);

  std::string m_title;
  double m_textScale;
  Eigen::Vector2d m_origin = Eigen::Vector2d::Zero();  ///< of the scene, map frame, m
  std::vector<MapPole> m_map;                          ///< in the scene's frame
  Eigen::Vector2d m_centre;                            ///< of the map, in the scene's frame, m
  double m_extent = 0;                                 ///< of the map, m
  std::optional<Pose2D> m_aimed;                       ///< the camera's heading is its yaw
  viz::Scene::Ptr m_scene;
};

/// \brief The points of the ellipse that holds 95 % of a Gaussian's positions, the first again at
/// the end, m. Lines where the covariance is singular.
std::vector<Eigen::Vector2d> ellipse95(const PoseWithCovariance& pose, int corners = 48);

/// \brief Lines of text on health and filter: the state with its reason first.
std::vector<std::string> describe(const LiveMoment& moment);

}  // namespace polemcl::report
