#include <gtest/gtest.h>
#include <mrpt/opengl/CCylinder.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <polemcl/report/DiffScene.h>

#include "views.h"

namespace polemcl::report {
namespace {

std::size_t cylinders(mrpt::opengl::COpenGLScene& scene, const char* name) {
  const auto group = std::dynamic_pointer_cast<mrpt::opengl::CSetOfObjects>(scene.getByName(name));
  if (!group) return 999;
  std::size_t count = 0;
  for (const auto& object : *group)
    count += std::dynamic_pointer_cast<mrpt::opengl::CCylinder>(object) != nullptr;
  return count;
}

}  // namespace

TEST(DiffScene, EachKindInItsGroup) {
  const MapDiff diff = diffMaps({poleAt(0, 0), poleAt(10, 0), poleAt(20, 8), poleAt(25, 8)},
                                {poleAt(0, 0), poleAt(11, 0.5), poleAt(30, 4)});
  const auto scene = makeDiffScene(diff);
  EXPECT_EQ(cylinders(*scene, "same"), 1u);
  EXPECT_EQ(cylinders(*scene, "new"), 1u);
  EXPECT_EQ(cylinders(*scene, "vanished"), 2u);
  EXPECT_EQ(cylinders(*scene, "moved"), 1u);
}

TEST(DiffScene, PlacesAndHeightsAreThoseOfThePoles) {
  const auto scene = makeDiffScene(diffMaps({}, {poleAt(3, 4)}));
  const auto group =
      std::dynamic_pointer_cast<mrpt::opengl::CSetOfObjects>(scene->getByName("new"));
  ASSERT_EQ(group->size(), 1u);
  const auto pole = std::dynamic_pointer_cast<mrpt::opengl::CCylinder>(*group->begin());
  EXPECT_EQ(pole->getPoseX(), 3);
  EXPECT_EQ(pole->getPoseY(), 4);
  EXPECT_EQ(pole->getPoseZ(), 0.5);
  EXPECT_NEAR(pole->getHeight(), 4, 1e-6);
}

TEST(DiffScene, RefusesNothing) {
  EXPECT_THROW(makeDiffScene({}), Error);
}

}  // namespace polemcl::report
