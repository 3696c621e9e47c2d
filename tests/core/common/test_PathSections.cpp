#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/common/PathSections.h"

namespace polemcl::test_path_sections {
namespace {

PathSections split(const std::vector<Pose2D>& poses, double length) {
  return splitPath(poses, std::vector<std::uint32_t>(poses.size(), 0), length);
}

std::vector<Pose2D> straight(const std::vector<double>& ways) {
  std::vector<Pose2D> poses;
  for (double way : ways) poses.push_back({3 + 0.6 * way, -2 + 0.8 * way, 0});
  return poses;
}

using Scans = std::vector<std::size_t>;

TEST(PathSections, StraightPathByHand) {
  const auto result = split(straight({0, 0.4, 0.8, 1.0, 1.7, 2.2, 3.9}), 1);
  ASSERT_EQ(result.occupied.size(), 4u);
  EXPECT_EQ(result.count, 4u);
  EXPECT_NEAR(result.length, 3.9, 1e-12);
  EXPECT_EQ(result.occupied[0].scans, (Scans{0, 1, 2}));
  EXPECT_EQ(result.occupied[1].scans, (Scans{3, 4}));
  EXPECT_EQ(result.occupied[2].scans, (Scans{5}));
  EXPECT_EQ(result.occupied[3].scans, (Scans{6}));
  EXPECT_EQ(result.occupied[0].middle, 1u);  // 0.4 is nearest to 0.5
  EXPECT_EQ(result.occupied[1].middle, 4u);  // 1.7 is nearer to 1.5 than 1.0
}

TEST(PathSections, OfEqualsTheFirstIsTheMiddle) {
  EXPECT_EQ(split(straight({0.0, 0.4, 0.6}), 1).occupied[0].middle, 1u);
}

TEST(PathSections, SectionsWithoutAScanAreCountedButNotOccupied) {
  const auto result = split(straight({0, 5.5}), 1);
  ASSERT_EQ(result.occupied.size(), 2u);
  EXPECT_EQ(result.occupied[1].index, 5u);
  EXPECT_EQ(result.count, 6u);
}

TEST(PathSections, AWholeNumberOfSectionsDoesNotFallShort) {
  std::vector<double> ways;
  for (int i = 0; i <= 3000; ++i) ways.push_back(0.1 * i);
  const auto result = split(straight(ways), 0.3);
  ASSERT_EQ(result.occupied.size(), 1001u);
  for (std::size_t k = 0; k < 1000; ++k)
    EXPECT_EQ(result.occupied[k].scans, (Scans{3 * k, 3 * k + 1, 3 * k + 2}));
}

TEST(PathSections, FollowTheCurve) {
  std::vector<Pose2D> poses;
  for (int i = 0; i <= 2000; ++i)
    poses.push_back({8 * std::cos(i * M_PI / 1000), 8 * std::sin(i * M_PI / 1000), 0});
  const auto result = split(poses, 1.5);
  EXPECT_NEAR(result.length, 2 * M_PI * 8, 0.02);
  EXPECT_EQ(result.count, 34u);  // 50.27 m
}

TEST(PathSections, GoingBackIsTravelling) {
  std::vector<double> ways;
  for (int i = 0; i <= 10; ++i) ways.push_back(i);
  for (int i = 9; i >= 0; --i) ways.push_back(i);
  const auto result = split(straight(ways), 2);
  EXPECT_NEAR(result.length, 20, 1e-9);
  EXPECT_EQ(result.occupied.size(), 11u);
}

TEST(PathSections, JitterOfAStandingVehicleAddsNothing) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> jitter(-0.01, 0.01);
  std::vector<Pose2D> poses;
  for (int i = 0; i < 5000; ++i) poses.push_back({20.75 + jitter(random), jitter(random), 0});
  const auto result = split(poses, 1.5);
  EXPECT_EQ(result.count, 1u);
  EXPECT_LT(result.length, 0.04);
}

TEST(PathSections, AnotherDriveStartsAPathOfItsOwn) {
  const std::vector<Pose2D> poses = straight({0, 1.2, 500, 500.4, 3});
  const auto result = splitPath(poses, {7, 7, 2, 2, 7}, 1);
  ASSERT_EQ(result.occupied.size(), 4u);
  EXPECT_EQ(result.count, 4u);
  EXPECT_NEAR(result.length, 1.2 + 0.4, 1e-9);
  EXPECT_EQ(result.occupied[1].path, 0u);
  EXPECT_EQ(result.occupied[2].path, 1u);
  EXPECT_EQ(result.occupied[2].index, 0u);
  EXPECT_EQ(result.occupied[2].scans, (Scans{2, 3}));
  EXPECT_EQ(result.occupied[3].path, 2u);
}

TEST(PathSections, NoPosesNoSections) {
  const auto result = split({}, 1);
  EXPECT_TRUE(result.occupied.empty());
  EXPECT_EQ(result.count, 0u);
}

TEST(PathSections, WhatIsNotUsedIsWayButNoScan) {
  const auto poses = straight({0, 0.4, 0.8, 1.0, 1.7, 2.2, 3.9});
  const std::vector<std::uint32_t> drives(poses.size(), 0);
  const auto result = splitPath(poses, drives, 1, {true, false, true, false, false, true, false});
  ASSERT_EQ(result.occupied.size(), 2u);
  EXPECT_EQ(result.count, 2u);  // only unused scans pass the others
  EXPECT_NEAR(result.length, 3.9, 1e-12);
  EXPECT_EQ(result.occupied[0].scans, (Scans{0, 2}));
  EXPECT_EQ(result.occupied[0].middle, 2u);  // 0.8 is nearer to 0.5 than 0.0
  EXPECT_EQ(result.occupied[1].index, 2u);
  EXPECT_EQ(result.occupied[1].scans, (Scans{5}));
}

/// The rule written down as lists over the whole way, one after the other.
struct Lists {
  std::vector<std::size_t> middles, ends;
  Lists(const std::vector<double>& ways, double length) {
    for (std::size_t i = 0; i < ways.size(); ++i) {
      if (ways[i] >= static_cast<double>(middles.size()) * length + 0.5 * length)
        middles.push_back(i);
      if (ways[i] > static_cast<double>(ends.size()) * length + length) ends.push_back(i);
    }
    middles.resize(ends.size());
  }
};

Scans middlesOf(const PathSections& sections) {
  Scans result;
  for (const PathSection& section : sections.occupied) result.push_back(section.middle);
  return result;
}

PathSections pass(const std::vector<Pose2D>& poses, double length) {
  return passSections(poses, std::vector<std::uint32_t>(poses.size(), 0), length);
}

TEST(PathSections, PassedMiddlesByHand) {
  // 0.4 is nearer to 0.5, but 0.75 is the first past it; the end of section 1 is the first past 2.
  const auto result = pass(straight({0, 0.4, 0.75, 1.125, 1.5, 2, 2.25, 2.5, 3}), 1);
  EXPECT_EQ(middlesOf(result), (Scans{2, 4}));
  EXPECT_EQ(result.count, 2u);  // the way ends at 3, not past it
  EXPECT_NEAR(result.length, 3, 1e-12);
  EXPECT_EQ(result.occupied[1].index, 1u);
}

TEST(PathSections, ScansFarApartAreAllMiddlesAndAStandingVehicleMakesUp) {
  // After 4 m in two scans four sections are behind, two of them made up for while standing.
  const auto result = pass(straight({0, 2, 4.25, 4.25, 4.25, 4.25, 4.25}), 1);
  EXPECT_EQ(middlesOf(result), (Scans{1, 2, 3, 4}));
}

TEST(PathSections, PassedMiddlesEqualTheLists) {
  std::mt19937_64 random(3);
  for (int round = 0; round < 50; ++round) {
    std::uniform_real_distribution<double> step(0, round % 2 ? 0.4 : 2.5);
    std::vector<double> ways{0};
    for (int i = 0; i < 200; ++i) ways.push_back(ways.back() + (i % 40 < 30 ? step(random) : 0));
    std::vector<Pose2D> poses;
    for (const double way : ways) poses.push_back({way, 0, 0});
    EXPECT_EQ(middlesOf(pass(poses, 1)), Lists(ways, 1).middles);
  }
}

TEST(PathSections, PassedDrivesCountForThemselvesAndUnusedMiddlesAreLeftOut) {
  const std::vector<Pose2D> poses = straight({0, 0.625, 1.25, 1.625, 2.25, 500, 500.625, 501.25});
  const std::vector<std::uint32_t> drives{0, 0, 0, 0, 0, 1, 1, 1};
  const auto all = passSections(poses, drives, 1);
  EXPECT_EQ(middlesOf(all), (Scans{1, 3, 6}));
  EXPECT_EQ(all.count, 3u);
  EXPECT_NEAR(all.length, 2.25 + 1.25, 1e-9);
  EXPECT_EQ(all.occupied[2].path, 1u);
  EXPECT_EQ(all.occupied[2].index, 0u);
  const auto some =
      passSections(poses, drives, 1, {true, false, true, true, true, true, true, true});
  EXPECT_EQ(middlesOf(some), (Scans{3, 6}));
  EXPECT_EQ(some.count, 2u);
  EXPECT_TRUE(passSections({}, {}, 1).occupied.empty());
}

}  // namespace
}  // namespace polemcl::test_path_sections
