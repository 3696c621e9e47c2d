#pragma once
/// \file Compatibility.h
/// \brief What newer releases of MRPT have changed in what this project uses.
///
/// Everything is built and tested with MRPT 2.5.8 (Debian 12) and 2.14.7 (Debian 13). The lines for
/// 3 are untested (share/doc/mrpt.md).

#include <mrpt/img/CImage.h>
#include <mrpt/maps/CMetricMap.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/version.h>

// MRPT_VERSION is 0x258 in 2.5.8 and 0x020A02 from 2.10.2 on: it grows, but not digit by digit.
#if MRPT_VERSION >= 0x030000  // untested
#include <mrpt/maps/CGenericPointsMap.h>
#include <mrpt/viz/CCamera.h>
#include <mrpt/viz/CCylinder.h>
#include <mrpt/viz/CGridPlaneXY.h>
#include <mrpt/viz/CPointCloudColoured.h>
#include <mrpt/viz/CSetOfLines.h>
#include <mrpt/viz/CSetOfObjects.h>
#include <mrpt/viz/CSetOfTriangles.h>
#include <mrpt/viz/CText.h>
#include <mrpt/viz/Scene.h>
#include <mrpt/viz/Visualizable.h>
#else
#include <mrpt/maps/CPointsMapXYZI.h>
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
#endif

#include <type_traits>

/// Defines the virtual function of an observation that gives the pose of the sensor, a member.
#if MRPT_VERSION >= 0x030000  // untested
#define POLEMCL_GET_SENSOR_POSE(member)                 \
  mrpt::poses::CPose3D getSensorPose() const override { \
    return member;                                      \
  }
#else
#define POLEMCL_GET_SENSOR_POSE(member)                                     \
  void getSensorPose(mrpt::poses::CPose3D& out_sensorPose) const override { \
    out_sensorPose = member;                                                \
  }
#endif

namespace polemcl {

/// \brief The classes of scenes, under their names in MRPT 3.
namespace viz {
#if MRPT_VERSION >= 0x030000  // untested
using namespace mrpt::viz;
#else
using namespace mrpt::opengl;
using CVisualObject = mrpt::opengl::CRenderizable;
using Scene = mrpt::opengl::COpenGLScene;
using Viewport = mrpt::opengl::COpenGLViewport;
#endif
}  // namespace viz

/// \brief What CPoleMap::internal_CreateFromMapDefinition() returns.
#if MRPT_VERSION >= 0x020B03
using CreatedMap = mrpt::maps::CMetricMap::Ptr;
#else
using CreatedMap = mrpt::maps::CMetricMap*;  // owned by the caller
#endif

/// \brief A cloud of points with intensities.
#if MRPT_VERSION >= 0x030000  // untested
using IntensityCloud = mrpt::maps::CGenericPointsMap;
#else
using IntensityCloud = mrpt::maps::CPointsMapXYZI;
#endif

/// \brief Sets the number of points, all with an intensity.
inline void resizeCloud(IntensityCloud& cloud, std::size_t points) {
#if MRPT_VERSION >= 0x030000  // untested
  cloud.registerField_float(IntensityCloud::POINT_FIELD_INTENSITY);
#endif
  cloud.resize(points);
}

/// \brief Sets the intensity of the point with this index.
inline void setIntensity(IntensityCloud& cloud, std::size_t index, float intensity) {
#if MRPT_VERSION >= 0x030000  // untested
  cloud.setPointField_float(index, IntensityCloud::POINT_FIELD_INTENSITY, intensity);
#else
  cloud.setPointIntensity(index, intensity);
#endif
}

/// \brief Makes the light of a viewport white. Strengths are from 0 to 1.
template <class Lights>
void setLight(Lights& lights, float ambient, float diffuse, float specular) {
#if MRPT_VERSION >= 0x030000  // untested
  lights.ambient = ambient;
  for (auto& light : lights.lights) {
    light.color = {1.0f, 1.0f, 1.0f};
    light.diffuse = diffuse;
    light.specular = specular;
  }
#else
  const auto set = [](auto& light, float strength) {
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(light)>>)
      light = strength;  // 2.15, untested
    else
      light = {strength, strength, strength, 1.0f};
  };
  set(lights.ambient, ambient);
  set(lights.diffuse, diffuse);
  set(lights.specular, specular);
#endif
}

/// \brief Makes a renderer (CFBORender) look at a scene through a camera.
template <class Renderer>
void useCamera(Renderer& renderer, [[maybe_unused]] const viz::Scene& scene,
               const viz::CCamera& camera) {
#if MRPT_VERSION >= 0x030000  // untested
  renderer.setCamera(camera);
#else
  renderer.setCamera(scene, camera);
#endif
}

/// \brief Copies a rectangle of a picture. Numbers are pixels, from the upper left corner.
inline void copyPatch(const mrpt::img::CImage& image, mrpt::img::CImage& patch, int x, int y,
                      int width, int height) {
#if MRPT_VERSION >= 0x030000  // untested
  image.extract_patch(patch, {x, y}, {width, height});
#else
  image.extract_patch(patch, static_cast<unsigned>(x), static_cast<unsigned>(y),
                      static_cast<unsigned>(width), static_cast<unsigned>(height));
#endif
}

/// \brief Draws a picture into another one, with its upper left corner at x, y, in pixels.
inline void drawImage(mrpt::img::CImage& onto, int x, int y, const mrpt::img::CImage& image) {
#if MRPT_VERSION >= 0x030000  // untested
  onto.drawImage({x, y}, image);
#else
  onto.drawImage(x, y, image);
#endif
}

}  // namespace polemcl
