#pragma once
/// \file MapScene.h
/// \brief The drive as a 3D scene of stock MRPT objects: SceneViewer3D opens it without a plugin.

#include <mrpt/opengl/COpenGLScene.h>
#include <polemcl/report/MapView.h>

#include <filesystem>

namespace polemcl::report {

/// \brief Poles as upright cylinders from their bottom to their top, `truth` and `estimate` as
/// lines just above the ground (z = 0), a ground grid below all of it.
///
/// Names of the objects: `ground`, `poles`, `truth`, `estimate`. The camera looks down at the
/// whole. \throws Error when there is nothing to show, or a coordinate is not finite.
mrpt::opengl::COpenGLScene::Ptr makeMapScene(const MapView& view);

/// \brief Writes a `.3Dscene`, atomically. \throws Error when it cannot be written.
void saveScene(const mrpt::opengl::COpenGLScene& scene, const std::filesystem::path& file);

}  // namespace polemcl::report
