#pragma once
/// \file PoleDrawing.h
/// \brief Poles as objects of MRPT's scenes.

#include <mrpt/img/TColor.h>
#include <mrpt/opengl/CSetOfObjects.h>

namespace polemcl {

/// \brief Inserts an upright cylinder. \param bottom,top Heights above z = 0, m.
/// Poles thinner than 3 cm are drawn that thick: thinner ones cannot be seen.
void drawPole(mrpt::opengl::CSetOfObjects& scene, double x, double y, double radius, double bottom,
              double top, const mrpt::img::TColor& colour, const std::string& name);

}  // namespace polemcl
