#pragma once
/// \file DiffScene.h
/// \brief What changed between two maps as a 3D scene of stock MRPT objects.

#include <mrpt/opengl/COpenGLScene.h>
#include <polemcl/core/MapDiff.h>

namespace polemcl::report {

/// \brief Upright cylinders from bottom to top, ground at z = 0: grey what stayed, green what is
/// new, orange what vanished, blue what moved, with a line from its old place.
///
/// Names of the objects: `same`, `new`, `vanished`, `moved`. Write it with saveScene().
/// \throws Error when both maps are empty.
mrpt::opengl::COpenGLScene::Ptr makeDiffScene(const MapDiff& diff);

}  // namespace polemcl::report
