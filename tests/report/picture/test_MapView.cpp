#include <gtest/gtest.h>

#include <cmath>

#include "report/picture/MapView.h"
#include "support/Refusal.h"
#include "support/SampleViews.h"

namespace polemcl::report::test_map_view {

TEST(MapView, BoundsCoverPolesTruthAndEstimate) {
  MapView view = smallDrive();
  view.truth.front().pose.x = -3;
  view.estimate.back().pose.y = 9;
  const Bounds bounds = boundsOf(view);
  EXPECT_EQ(bounds.xMin, -3);
  EXPECT_EQ(bounds.xMax, 20);
  EXPECT_EQ(bounds.yMin, -6);
  EXPECT_EQ(bounds.yMax, 9);
}

TEST(MapView, RefusesNothing) {
  EXPECT_THROW(boundsOf({}), Error);
}

TEST(MapView, NamesTheValueThatIsNotFinite) {
  MapView view = smallDrive();
  view.estimate[7].pose.y = std::nan("");
  EXPECT_REFUSED(boundsOf(view), "estimated pose 7");
}

}  // namespace polemcl::report::test_map_view
