#include "PoleDrawing.h"

#include <mrpt/opengl/CCylinder.h>

#include <algorithm>

namespace polemcl {

void drawPole(mrpt::opengl::CSetOfObjects& scene, double x, double y, double radius, double bottom,
              double top, const mrpt::img::TColor& colour, const std::string& name) {
  const auto drawn = static_cast<float>(std::max(radius, 0.03));
  const auto height = static_cast<float>(std::max(top - bottom, 0.01));
  auto cylinder = mrpt::opengl::CCylinder::Create(drawn, drawn, height);
  cylinder->setSlicesCount(12);
  cylinder->setLocation(x, y, bottom);
  cylinder->setColor_u8(colour);
  cylinder->setName(name);
  scene.insert(cylinder);
}

}  // namespace polemcl
