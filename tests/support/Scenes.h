#pragma once
// Reads back the content of a scene.

#include <mrpt/opengl/CCylinder.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfObjects.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace polemcl::report {

inline std::vector<mrpt::opengl::CCylinder::Ptr> cylindersOf(
    const mrpt::opengl::COpenGLScene::Ptr& scene, const std::string& name) {
  std::vector<mrpt::opengl::CCylinder::Ptr> cylinders;
  const auto set =
      std::dynamic_pointer_cast<mrpt::opengl::CSetOfObjects>(scene->getViewport()->getByName(name));
  if (!set) return cylinders;
  for (const auto& object : *set)
    if (auto cylinder = std::dynamic_pointer_cast<mrpt::opengl::CCylinder>(object))
      cylinders.push_back(cylinder);
  return cylinders;
}

/// In metres, in the frame of the object that holds it.
inline mrpt::math::TBoundingBox boxOf(const mrpt::opengl::COpenGLScene::Ptr& scene,
                                      const std::string& name) {
  const auto object = scene->getViewport()->getByName(name);
  if (!object) throw std::runtime_error("no " + name + " in the scene");
  return object->getBoundingBox();
}

/// All lines of the legend.
inline std::string legendOf(const mrpt::opengl::COpenGLScene::Ptr& scene) {
  std::string all;
  for (const auto& [index, text] : scene->getViewport("text")->getTextMessages().messages)
    all += text.text + "\n";
  return all;
}

}  // namespace polemcl::report
