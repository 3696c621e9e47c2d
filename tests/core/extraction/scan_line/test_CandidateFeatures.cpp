#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/extraction/scan_line/CandidateFeatures.h"
#include "support/RayCast.h"

namespace polemcl::test_candidate_features {
namespace {

using namespace polemcl::clouds;

ScanLineSegment segmentAt(double x, double y, double z, double width = 0.2) {
  ScanLineSegment s;
  s.x = static_cast<float>(x);
  s.y = static_cast<float>(y);
  s.z = static_cast<float>(z);
  s.rho = static_cast<float>(std::hypot(x, y));
  s.azimuthEnd = static_cast<float>(width / s.rho);
  s.count = 3;
  return s;
}

ClusterShape shapeOf(const std::vector<ScanLineSegment>& segments) {
  std::vector<std::uint32_t> indices(segments.size());
  std::iota(indices.begin(), indices.end(), 0u);
  return measureShape(segments, {indices.data(), indices.size()});
}

constexpr double kHeight = 1.0;     ///< of the sensor above ground
constexpr float kClearance = 0.1f;  ///< of the returns used above ground
constexpr double kDistance = 8.0;   ///< of the pole
constexpr double kRadius = 0.1;

/// The cluster of the pole at (kDistance, 0) in a scene, scanned by an HDL-32E, and its features.
struct Look {
  SensorModel sensor;
  ScanLines lines;
  GroundGrid ground;
  std::vector<ScanLineSegment> segments;
  std::vector<std::uint32_t> members;
  ClusterShape shape;
  PoleAxis axis;
  CandidateFeatures features;
  explicit Look(Scene scene, const GroundPlane& plane = {-kHeight, 0, 0})
      : sensor(hdl32e()), lines(sensor) {
    scene.ground = plane;
    scene.walls.push_back({30, -40, 30, 40, -5, 20});
    const PointList points = cast(scene, sensor, {0.01, 0, 3});
    ground.build(points.view(), 1, 60, kHeight);
    lines.build(points.view(), ground, kClearance);
    const ScanLineOptions options;
    ScanLineSegmenter(sensor, options).find(lines, segments);
    SegmentClustering stacker(sensor, options);
    for (const SegmentCluster& s : stacker.cluster(segments))
      if (std::hypot(segments[s.top()].x - kDistance, segments[s.top()].y) < 0.5 &&
          s.count > members.size())
        members.assign(s.begin(), s.end());
    EXPECT_GE(members.size(), 2u);
    shape = measureShape(segments, cluster());
    axis = {static_cast<float>(kDistance), 0, static_cast<float>(kRadius)};
    features = computeFeatures(lines, sensor, ground, segments, cluster(), shape, axis);
  }
  SegmentCluster cluster() const { return {members.data(), members.size()}; }
  float clutter() const { return clutteredShare(lines, sensor, segments, cluster(), axis); }
  /// The lowest of the rows may meet the ground in the ring.
  float groundShare() const { return 1.01f / static_cast<float>(members.size()); }
  /// Beams that meet the front of the pole between two heights, lidar frame.
  int beamsBetween(double low, double high) const {
    int n = 0;
    for (int row = 0; row < sensor.beamCount(); ++row) {
      const double z = (kDistance - kRadius) * sensor.beam(row).slope;
      n += z > low && z < high;
    }
    return n;
  }
  static SensorModel hdl32e() {
    SensorOptions options;
    options.model = "hdl32e";
    return SensorModel(options);
  }
};

/// A part of the pole, heights in the lidar frame.
Cylinder part(double low, double high) {
  return {kDistance, 0, kRadius, low, high};
}
/// A board across the pole, a little before its middle.
Wall board(double low, double high, double halfWidth) {
  return {kDistance - 0.05, -halfWidth, kDistance - 0.05, halfWidth, low, high};
}
constexpr double kBeamGap = kDistance * 1.4 * kDegree;  ///< a little more than between two beams

TEST(ClusterShape, OfAnUprightStackIsStraight) {
  const ClusterShape s = shapeOf({segmentAt(5, 1, 2), segmentAt(5, 1, 1), segmentAt(5, 1, -1)});
  EXPECT_EQ(s.points, 9);
  EXPECT_EQ(s.wholeSegments, 3);
  EXPECT_FLOAT_EQ(s.high, 2);
  EXPECT_FLOAT_EQ(s.low, -1);
  EXPECT_NEAR(s.scatter, 0, 1e-6);
  EXPECT_NEAR(s.tilt, 0, 1e-6);
  EXPECT_NEAR(s.widthSpread, 0, 1e-6);
}

TEST(ClusterShape, ALeaningStackIsStraightButTilted) {
  std::vector<ScanLineSegment> segments;
  for (int i = 0; i < 6; ++i)
    segments.push_back(segmentAt(5 - 0.06 * i, 1 - 0.08 * i, 2 - 0.5 * i));
  const ClusterShape s = shapeOf(segments);
  EXPECT_NEAR(s.tilt, std::atan(0.2), 1e-4);  // 0.1 m aside per 0.5 m
  EXPECT_NEAR(s.scatter, 0, 1e-4);
}

TEST(ClusterShape, ScatterIsTheRmsDistanceFromTheLine) {
  // The line through 0, 0.1, 0 leaves -1/30, 2/30, -1/30; one degree of freedom is left.
  const ClusterShape s = shapeOf({segmentAt(5, 0, 1), segmentAt(5, 0.1, 0), segmentAt(5, 0, -1)});
  EXPECT_NEAR(s.scatter, std::sqrt(6.0 / 900), 1e-5);
  EXPECT_NEAR(s.tilt, 0, 1e-6);
}

TEST(ClusterShape, TwoSlicesAreAlwaysStraight) {
  EXPECT_EQ(shapeOf({segmentAt(5, 0, 1), segmentAt(5.2, 0.1, 0)}).scatter, 0);
}

TEST(ClusterShape, SlicesOfOneHeightHaveNoTilt) {
  const ClusterShape s = shapeOf({segmentAt(5, 0, 1), segmentAt(5.2, 0.1, 1)});
  EXPECT_EQ(s.tilt, 0);
  EXPECT_EQ(s.high, s.low);
}

TEST(ClusterShape, WidthSpreadIsTheStandardDeviation) {
  const ClusterShape s =
      shapeOf({segmentAt(5, 0, 2, 0.1), segmentAt(5, 0, 1, 0.1), segmentAt(5, 0, 0, 0.4)});
  EXPECT_NEAR(s.widthSpread, std::sqrt(0.02), 1e-5);
}

TEST(ClusterShape, WholeSlicesHaveBothSidesFree) {
  std::vector<ScanLineSegment> segments = {segmentAt(5, 0, 2), segmentAt(5, 0, 1),
                                           segmentAt(5, 0, 0)};
  segments[1].left = Side::occluded;
  EXPECT_EQ(shapeOf(segments).wholeSegments, 2);
}

TEST(CandidateFeatures, OfAPostAlone) {
  const Look look({{part(-1, 0.9)}, {}, {}});
  // Where the ground is is known to a few centimetres.
  EXPECT_GE(static_cast<int>(look.members.size()), look.beamsBetween(-1 + kClearance + 0.05, 0.9));
  EXPECT_LE(static_cast<int>(look.members.size()), look.beamsBetween(-1 + kClearance - 0.05, 0.9));
  EXPECT_EQ(look.features.rowsPassed, 0);
  EXPECT_EQ(look.features.rowsWide, 0);
  EXPECT_LE(look.clutter(), look.groundShare());
  EXPECT_GE(look.features.bottom, -0.02);
  EXPECT_LE(look.features.bottom, kClearance + kBeamGap);
  EXPECT_LE(look.features.top, 1.9);
  EXPECT_GE(look.features.top, 1.9 - kBeamGap);
  // The first beam that passed over it.
  EXPECT_GT(look.features.topBound, 1.9);
  EXPECT_LT(look.features.topBound, 1.9 + 1.05 * kBeamGap);
}

TEST(CandidateFeatures, OfAPostThatLeavesTheView) {
  const Look look({{part(-1, 5)}, {}, {}});
  EXPECT_NEAR(look.features.top, kHeight + (kDistance - kRadius) * look.sensor.beam(0).slope, 0.05);
  EXPECT_TRUE(std::isinf(look.features.topBound));
}

TEST(CandidateFeatures, RowsThatSeeThroughAreCounted) {
  const Look look({{part(-1, 0), part(0.6, 1.4)}, {}, {}});
  const int through = look.beamsBetween(0, 0.6);
  EXPECT_GE(through, 2);
  EXPECT_EQ(look.features.rowsPassed, through);
  EXPECT_EQ(look.features.rowsWide, 0);
}

TEST(CandidateFeatures, RowsThatMeetABoardAreWide) {
  const Look look({{part(-1, 1.4)}, {board(0, 0.6, 1.0)}, {}});
  EXPECT_EQ(look.features.rowsWide, look.beamsBetween(0, 0.6));
  EXPECT_EQ(look.features.rowsPassed, 0);
}

TEST(CandidateFeatures, WhatStandsOnThePoleIsItsTop) {
  const Look look({{part(-1, 0.5)}, {board(0.5, 1.2, 0.8)}, {}});
  EXPECT_LE(look.shape.high, 0.5);
  EXPECT_LE(look.features.top, 2.2);
  EXPECT_GE(look.features.top, 2.2 - kBeamGap);
  EXPECT_GT(look.features.topBound, 2.2);
}

TEST(CandidateFeatures, OneSilentRowDoesNotEndThePole) {
  // A slit that one beam looks through; above it a board.
  const SensorModel sensor = Look::hdl32e();
  int row = 0;
  while (kDistance * sensor.beam(row).slope > 0.5) ++row;
  const double slit = (kDistance - kRadius) * sensor.beam(row).slope;
  const Look look({{part(-1, slit - 0.03)}, {board(slit + 0.03, 1.2, 0.8)}, {}});
  EXPECT_GE(look.features.top, 2.2 - kBeamGap);
}

TEST(CandidateFeatures, WhereSomethingHidesTheTopItIsUnknown) {
  const Look look({{part(-1, 1.4)}, {{4, -1, 4, 1, 0.3, 3}}, {}});
  EXPECT_LT(look.features.top, 1.75);
  EXPECT_TRUE(std::isinf(look.features.topBound));
}

TEST(CandidateFeatures, HeightsAreAboveTheLocalGround) {
  const GroundPlane slope{-kHeight, 0.07, 0};
  const double base = slope.at(kDistance, 0);  // 0.56 m above the ground below the sensor
  const Look look({{part(base, base + 1.5)}, {}, {}}, slope);
  EXPECT_NEAR(look.features.top, 1.5, kBeamGap + 0.25);
  EXPECT_NEAR(look.features.bottom, 0, kBeamGap + 0.25);
}

TEST(CandidateFeatures, OtherThingsInTheRingClutter) {
  // A second post 0.45 m beside, up to half the height.
  const Look look({{part(-1, 1.4), {kDistance, 0.45, 0.05, -1, 0.2}}, {}, {}});
  const double expected =
      static_cast<double>(look.beamsBetween(-1, 0.2)) / look.beamsBetween(-1, 1.4);
  EXPECT_NEAR(look.clutter(), expected, 0.08);
}

TEST(CandidateFeatures, WhatIsOutsideTheRingDoesNotClutter) {
  const Look look({{part(-1, 1.4), {kDistance, 0.85, 0.05, -1, 1.4}}, {}, {}});
  EXPECT_LE(look.clutter(), look.groundShare());
}

}  // namespace
}  // namespace polemcl::test_candidate_features
