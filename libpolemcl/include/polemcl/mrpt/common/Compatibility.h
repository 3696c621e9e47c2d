#pragma once
/// \file Compatibility.h
/// \brief What releases of MRPT have changed in what this project uses: built, tested and run with
/// 2.5.8 (Debian 12), 2.14.7 (Debian 13) and 2.15.14.

#include <mrpt/maps/CMetricMap.h>
#include <mrpt/opengl/CCamera.h>
#include <mrpt/opengl/CCylinder.h>
#include <mrpt/opengl/CGridPlaneXY.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CSetOfTriangles.h>
#include <mrpt/opengl/CText.h>
#include <mrpt/opengl/Visualizable.h>
#include <mrpt/version.h>

#include <type_traits>

namespace polemcl {

/// \brief Short names of the classes of scenes.
namespace viz {
using namespace mrpt::opengl;
using CVisualObject = mrpt::opengl::CRenderizable;
using Scene = mrpt::opengl::COpenGLScene;
using Viewport = mrpt::opengl::COpenGLViewport;
}  // namespace viz

/// \brief What CPoleMap::internal_CreateFromMapDefinition() returns.
/// MRPT_VERSION is 0x258 in 2.5.8 and 0x020A02 from 2.10.2 on: it grows, but not digit by digit.
#if MRPT_VERSION >= 0x020B03
using CreatedMap = mrpt::maps::CMetricMap::Ptr;
#else
using CreatedMap = mrpt::maps::CMetricMap*;  // owned by the caller
#endif

/// \brief Makes the light of a viewport white. Strengths are from 0 to 1.
template <class Lights>
void setLight(Lights& lights, float ambient, float diffuse, float specular) {
  const auto set = [](auto& light, float strength) {
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(light)>>)
      light = strength;  // from 2.15 on
    else
      light = {strength, strength, strength, 1.0f};
  };
  set(lights.ambient, ambient);
  set(lights.diffuse, diffuse);
  set(lights.specular, specular);
}

}  // namespace polemcl
