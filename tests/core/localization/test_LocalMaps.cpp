#include <gtest/gtest.h>

#include "core/common/Binder.h"
#include "core/localization/LocalMaps.h"
#include "support/Poles.h"

namespace polemcl::test_local_maps {
namespace {

using namespace polemcl::tests;

/// A drive with 0.25 m to the left turn of 0.1 rad a scan.
const Pose2D kStep{0.25, 0, 0.1};

Pose2D poseAfter(int scans) {
  Pose2D pose;
  for (int i = 0; i < scans; ++i) pose = compose(pose, kStep);
  return pose;
}

/// What scan number `scan` sees of a place given in the frame of the first scan.
PoleDetection seen(int scan, double x, double y) {
  const Pose2D p = relative(poseAfter(scan), {x, y, 0});
  return detectionAt(p.x, p.y);
}

LocalMapOptions options(int maps, int minHits) {
  LocalMapOptions result;
  result.sectionLength = 1;
  result.maps = maps;
  result.minHits = minHits;
  return result;
}

TEST(LocalMaps, GivesOutTheMiddleScansPolesWhenTheSectionEnds) {
  LocalMaps maps(options(1, 1));
  for (int scan = 0; scan < 20; ++scan) {
    // Each scan sees another place, 5 m ahead of it and a little aside.
    const auto poles = maps.add(kStep, {detectionAt(5, 0.01 * scan)});
    // Middles at 0.5, 1.5, … m are scans 2, 6, …; ends, past 1, 2, … m, scans 5, 9, …
    if (scan < 5 || scan % 4 != 1) {
      EXPECT_TRUE(poles.empty()) << scan;
      continue;
    }
    ASSERT_EQ(poles.size(), 1u) << scan;
    const int middle = scan - 3;
    const Pose2D place = compose(poseAfter(middle), {5, 0.01 * middle, 0});
    const Pose2D now = relative(poseAfter(scan), place);
    EXPECT_NEAR(poles[0].x, now.x, 1e-12);
    EXPECT_NEAR(poles[0].y, now.y, 1e-12);
  }
}

TEST(LocalMaps, OnlyWhatTheNewestSectionsConfirm) {
  LocalMaps maps(options(2, 2));
  std::vector<std::size_t> used;
  for (int scan = 0; scan < 30; ++scan) {
    // One pole at every middle, one at every second, one at every third, one stands alone.
    std::vector<PoleDetection> poles{seen(scan, 5, 3)};
    const int section = (scan - 2) / 4;
    if (section % 2 == 0) poles.push_back(seen(scan, -4, 2));
    if (section % 3 == 0) poles.push_back(seen(scan, 0, 7));
    poles.push_back(detectionAt(5, 0.4 * scan));
    const auto given = maps.add(kStep, poles);
    if (scan >= 5 && scan % 4 == 1) used.push_back(given.size());
    if (!given.empty()) {
      const PoleDetection truth = seen(scan, 5, 3);
      EXPECT_NEAR(given[0].x, truth.x, 1e-9);
      EXPECT_NEAR(given[0].y, truth.y, 1e-9);
    }
  }
  // At the first section nothing confirms anything.
  EXPECT_EQ(used, (std::vector<std::size_t>{0, 1, 1, 1, 1, 1, 1}));
}

TEST(LocalMaps, MoreSectionsConfirmMore) {
  const auto given = [](int count, int hits) {
    LocalMaps maps(options(count, hits));
    std::vector<std::size_t> used;
    for (int scan = 0; scan < 30; ++scan) {
      const int section = (scan - 2) / 4;
      std::vector<PoleDetection> poles;
      if (section % 3 == 0) poles = {seen(scan, 0, 7)};
      const auto now = maps.add(kStep, poles);
      if (scan >= 5 && scan % 4 == 1) used.push_back(now.size());
    }
    return used;
  };
  using Counts = std::vector<std::size_t>;
  EXPECT_EQ(given(1, 1), (Counts{1, 0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(given(3, 2), (Counts{0, 0, 0, 0, 0, 0, 0}));  // the last one is three sections back
  EXPECT_EQ(given(4, 2), (Counts{0, 0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(given(6, 3), (Counts{0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(given(7, 3), (Counts{0, 0, 0, 0, 0, 0, 1}));
}

TEST(LocalMaps, TwoOfOneScanConfirmEachOther) {
  LocalMaps maps(options(6, 2));
  std::size_t given = 0;
  for (int scan = 0; scan <= 5; ++scan)
    given += maps.add(kStep, {detectionAt(5, 0), detectionAt(5.15, 0), detectionAt(8, 0)}).size();
  EXPECT_EQ(given, 2u);
}

TEST(LocalMaps, BeginsAnewAfterClear) {
  LocalMaps maps(options(1, 1)), fresh(options(1, 1));
  for (int scan = 0; scan < 7; ++scan) maps.add(kStep, {detectionAt(5, 0)});
  maps.clear();
  for (int scan = 0; scan < 20; ++scan)
    EXPECT_EQ(maps.add(kStep, {detectionAt(5, 0)}).size(),
              fresh.add(kStep, {detectionAt(5, 0)}).size());
}

TEST(LocalMaps, FastVehiclesGiveOneSectionAScan) {
  LocalMaps maps(options(3, 1));
  for (int scan = 0; scan < 50; ++scan)
    EXPECT_EQ(maps.add({10, 0, 0}, {detectionAt(5, 0)}).size(), scan > 0 ? 1u : 0u);
}

}  // namespace
}  // namespace polemcl::test_local_maps
