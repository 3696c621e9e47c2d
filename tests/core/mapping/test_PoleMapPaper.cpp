#include <gtest/gtest.h>

#include <algorithm>

#include <polemcl/core/mapping/PoleMapBuilder.h>
#include "core/common/Binder.h"
#include "support/Poles.h"

namespace polemcl::test_pole_map_paper {
namespace {

/// The authors' program's map, with sections of 1 m.
PoleMapOptions authors(int minCount) {
  PoleMapOptions options;
  options.sectionLength = 1;
  options.everyScan = false;
  options.minShare = 0;
  options.middle = SectionMiddle::passed;
  options.merging = MapMerging::boxes;
  options.counting = PoleCounting::members;
  options.minCount = minCount;
  return options;
}

/// A scan a metre from 0.5 on, after one at the origin: the middle of each section. Each sees what
/// is given for it, map frame; a last scan ends the last section.
std::vector<MappingScan> drive(const std::vector<std::vector<Eigen::Vector2d>>& seen) {
  std::vector<MappingScan> scans(1);
  for (const auto& poles : seen) {
    MappingScan scan;
    scan.pose_map_robot = {scans.size() - 0.5, 0, 0};
    for (const Eigen::Vector2d& p : poles) {
      scan.poles_robot.push_back(tests::detectionAt(p.x() - scan.pose_map_robot.x, p.y()));
      scan.poles_robot.back().radius = 0.125;
    }
    scans.push_back(scan);
  }
  MappingScan last;
  last.pose_map_robot = {static_cast<double>(seen.size()) + 0.25, 0, 0};
  scans.push_back(last);
  return scans;
}

const Eigen::Vector2d pole(10, 5);

TEST(PoleMapPaper, AChainIsOnePoleOfPlainMean) {
  // Neighbours 0.2 m apart overlap, the ends, 0.8 m apart, do not.
  std::vector<std::vector<Eigen::Vector2d>> seen;
  for (int i = 0; i < 5; ++i) seen.push_back({{10 + 0.2 * i, 5}});
  auto options = authors(5);
  const PoleMapResult map = buildPoleMap(drive(seen), options);
  ASSERT_EQ(map.poles.size(), 1u);
  EXPECT_NEAR(map.poles[0].x, 10.4, 1e-12);
  EXPECT_EQ(map.poles[0].count, 5u);
  options.merging = MapMerging::gated;  // no detection farther than 0.3 m from its pole
  options.mergeDistance = 0.3;
  EXPECT_TRUE(buildPoleMap(drive(seen), options).poles.empty());
}

TEST(PoleMapPaper, TheMeanKnowsNoOutliersAndNoCertainty) {
  auto scans = drive({{pole}, {pole}, {pole}, {pole}, {{10.2, 5}}});
  for (std::size_t i = 1; i < 5; ++i) scans[i].poles_robot[0].covariance *= 1e-6;
  EXPECT_NEAR(buildPoleMap(scans, authors(5)).poles.at(0).x, 10.04, 1e-12);
  auto ours = authors(1);
  ours.merging = MapMerging::gated;
  EXPECT_NEAR(buildPoleMap(scans, ours).poles.at(0).x, 10, 5e-3);
}

TEST(PoleMapPaper, MembersCountWhereverTheyWereMade) {
  // Seen twice, missed in six sections, seen twice: four members, runs of two.
  const auto scans = drive({{pole}, {pole}, {}, {}, {}, {}, {}, {}, {pole}, {pole}});
  EXPECT_EQ(buildPoleMap(scans, authors(4)).poles.size(), 1u);
  EXPECT_TRUE(buildPoleMap(scans, authors(5)).poles.empty());
  EXPECT_EQ(buildPoleMap(scans, authors(5)).bestCount, 4);
  auto paper = authors(3);
  paper.counting = PoleCounting::run;
  EXPECT_TRUE(buildPoleMap(scans, paper).poles.empty());
  paper.minCount = 2;
  EXPECT_EQ(buildPoleMap(scans, paper).poles.size(), 1u);
}

TEST(PoleMapPaper, TwoMembersOfOneScanCountTwice) {
  const auto scans = drive({{pole, {10.1, 5}}});
  EXPECT_EQ(buildPoleMap(scans, authors(2)).poles.size(), 1u);
  auto paper = authors(2);
  paper.counting = PoleCounting::run;
  EXPECT_TRUE(buildPoleMap(scans, paper).poles.empty());
}

TEST(PoleMapPaper, OnlyMiddlesOfSectionsThatEndAreUsed) {
  auto scans = drive({{pole}, {{20, 5}}});
  scans.pop_back();  // section 1 does not end
  const PoleMapResult map = buildPoleMap(scans, authors(1));
  ASSERT_EQ(map.poles.size(), 1u);
  EXPECT_NEAR(map.poles[0].x, 10, 1e-12);
  EXPECT_EQ(map.keyframes, 1u);
  EXPECT_EQ(map.sections, 1u);
  auto nearest = authors(1);
  nearest.middle = SectionMiddle::nearest;
  EXPECT_EQ(buildPoleMap(scans, nearest).poles.size(), 2u);
}

TEST(PoleMapPaper, TheOrderOfDetectionsDoesNotMatter) {
  std::vector<std::vector<Eigen::Vector2d>> seen;
  for (int i = 0; i < 8; ++i) seen.push_back({{10.013 * i, 3}, {10 + 0.017 * i, 5}, {3, 0.37 * i}});
  auto scans = drive(seen);
  const auto before = buildPoleMap(scans, authors(1)).poles;
  for (auto& scan : scans) std::reverse(scan.poles_robot.begin(), scan.poles_robot.end());
  const auto after = buildPoleMap(scans, authors(1)).poles;
  ASSERT_GT(before.size(), 5u);
  tests::expectSame(before, after);
}

TEST(PoleMapPaper, EveryScanHasNoPassedMiddles) {
  auto options = authors(1);
  options.everyScan = true;
  EXPECT_THROW(checkOptions(options), Error);
}

}  // namespace
}  // namespace polemcl::test_pole_map_paper
