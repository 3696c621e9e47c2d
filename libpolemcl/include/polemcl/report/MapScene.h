#pragma once
/// \file MapScene.h
/// \brief The drive as a 3D scene of stock MRPT objects: SceneViewer3D opens it without a plugin.

#include <mrpt/opengl/COpenGLScene.h>
#include <polemcl/report/MapView.h>

#include <filesystem>

namespace polemcl::report {

/// \brief Poles as upright cylinders from their bottom to their top, the estimate as a
/// line, the truth as two lines 0.5 m to either side of it, a grid on the ground (z = 0).
///
/// Names of the objects: `ground`, `poles`, `truth`, `estimate`. The camera shows all of it.
/// \throws Error when there is nothing to show, or a coordinate is not finite.
mrpt::opengl::COpenGLScene::Ptr makeMapScene(const MapView& view);

/// \brief Writes a `.3Dscene`, atomically. \throws Error when it cannot be written.
void saveScene(const mrpt::opengl::COpenGLScene& scene, const std::filesystem::path& file);

}  // namespace polemcl::report
