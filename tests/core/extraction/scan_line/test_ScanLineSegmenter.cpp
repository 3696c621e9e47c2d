#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/extraction/scan_line/ScanLineSegmenter.h"
#include "support/Clouds.h"
#include "support/Sensors.h"
#include "support/WholeScan.h"

namespace polemcl::test_scan_line_segmenter {
namespace {

using namespace polemcl::clouds;

/// Two beams, ±1°; 720 firing steps of 0.5°: 8.7 cm at 10 m.
SensorModel twoBeams() {
  return SensorModel(tests::uniformSensor(2, 1, -1, 720));
}

/// A scan drawn by firing steps: step 0 looks to -x, steps count counter-clockwise.
class Drawing {
 public:
  static constexpr int kSteps = 720;
  explicit Drawing(double background) {
    if (background > 0) fill(0, 0, kSteps - 1, background);
  }
  /// Sets steps first..last (they may lie beyond the ends: the turn closes); range 0: no return.
  Drawing& fill(int row, int first, int last, double range) {
    for (int s = first; s <= last; ++s) {
      const int step = ((s % kSteps) + kSteps) % kSteps;
      if (range > 0)
        m_range[row][step] = range;
      else
        m_range[row].erase(step);
    }
    return *this;
  }
  Drawing turned(int steps) const {
    Drawing out(0);
    for (int row = 0; row < 2; ++row)
      for (const auto& [step, range] : m_range[row])
        out.fill(row, step + steps, step + steps, range);
    return out;
  }
  static double azimuth(int step) { return -M_PI + (step + 0.5) * 0.5 * kDegree; }

  std::vector<ScanLineSegment> segments(const ScanLineOptions& options = {}) const {
    const SensorModel sensor = twoBeams();
    PointList points;
    for (int row = 0; row < 2; ++row)
      for (const auto& [step, range] : m_range[row])
        points.add(range * std::cos(azimuth(step)), range * std::sin(azimuth(step)),
                   range * sensor.beam(row).slope);
    ScanLines lines(sensor);
    buildWhole(lines, points.view(), 1, 100);
    EXPECT_EQ(lines.size(0) + lines.size(1), points.size());
    std::vector<ScanLineSegment> found(3);  // what is left of the scan before must go
    ScanLineSegmenter(sensor, options).find(lines, found);
    return found;
  }

 private:
  std::map<int, double> m_range[2];
};

/// Five steps (44 cm, 35 cm between the end returns) at 10 m.
Drawing poleBefore(double background) {
  return Drawing(background).fill(0, 300, 304, 10);
}

TEST(Segments, APoleBeforeAFarWallIsOneWholeSlice) {
  const auto segments = poleBefore(12).segments();
  ASSERT_EQ(segments.size(), 1u);
  const ScanLineSegment& s = segments[0];
  EXPECT_EQ(s.row, 0);
  EXPECT_EQ(s.first, 300u);
  EXPECT_EQ(s.count, 5u);
  EXPECT_NEAR(s.azimuthBegin, Drawing::azimuth(300), 1e-6);
  EXPECT_NEAR(s.azimuthEnd, Drawing::azimuth(304), 1e-6);
  EXPECT_NEAR(s.rho, 10, 1e-5);
  EXPECT_NEAR(s.z, 10 * std::tan(1 * kDegree), 1e-5);
  EXPECT_NEAR(s.x, 10 * std::cos(Drawing::azimuth(302)), 1e-5);
  EXPECT_NEAR(s.y, 10 * std::sin(Drawing::azimuth(302)), 1e-5);
  EXPECT_NEAR(s.width(), 10 * 2 * kDegree, 1e-5);
  EXPECT_TRUE(s.whole());
}

TEST(Segments, TheStepToTheWallDecides) {
  EXPECT_EQ(poleBefore(10.1).segments().size(), 0u);  // one surface
  EXPECT_EQ(poleBefore(10.3).segments().size(), 0u);  // attached: less than 0.35 m
  EXPECT_EQ(poleBefore(10.5).segments().size(), 1u);
  EXPECT_EQ(poleBefore(12).segments().size(), 1u);
  EXPECT_EQ(poleBefore(9).segments().size(), 0u);  // a hole in a wall is no segment
}

TEST(Segments, TheSettingsAreHonoured) {
  ScanLineOptions options;
  options.connectStep = 0.05;
  options.edgeStep = 0.08;
  EXPECT_EQ(poleBefore(10.1).segments(options).size(), 1u);
  options = {};
  options.edgeStep = 3;
  EXPECT_EQ(poleBefore(12).segments(options).size(), 0u);
  options = {};
  options.maxWidth = 0.3;
  EXPECT_EQ(poleBefore(12).segments(options).size(), 0u);
  options = {};
  options.maxRange = 9.9;
  EXPECT_EQ(poleBefore(12).segments(options).size(), 0u);
}

TEST(Segments, BeforeNothingTheSidesAreFree) {
  const auto segments = Drawing(0).fill(1, 100, 103, 15).segments();
  ASSERT_EQ(segments.size(), 1u);
  EXPECT_EQ(segments[0].row, 1);
  EXPECT_TRUE(segments[0].whole());
}

TEST(Segments, AcrossTheSeam) {
  const auto segments = Drawing(12).fill(0, -2, 3, 10).segments();
  ASSERT_EQ(segments.size(), 1u);
  const ScanLineSegment& s = segments[0];
  EXPECT_EQ(s.first, 718u);
  EXPECT_EQ(s.count, 6u);
  EXPECT_NEAR(s.azimuthBegin, M_PI - 0.75 * kDegree, 1e-6);
  EXPECT_NEAR(s.azimuthEnd, M_PI + 1.75 * kDegree, 1e-6);
  EXPECT_NEAR(s.x, 10 * std::cos(M_PI + 0.5 * kDegree), 1e-5);
  EXPECT_NEAR(s.y, 10 * std::sin(M_PI + 0.5 * kDegree), 1e-5);
  EXPECT_TRUE(s.whole());
}

TEST(Segments, BesideTheSeamTheNeighboursAreAcrossIt) {
  EXPECT_EQ(Drawing(12).fill(0, 0, 3, 10).segments().size(), 1u);
  EXPECT_EQ(Drawing(12).fill(0, -4, -1, 10).segments().size(), 1u);
  // What continues as far behind the seam makes it attached; what is nearer there hides its end.
  EXPECT_EQ(Drawing(12).fill(0, 0, 3, 10).fill(0, -40, -1, 10.3).segments().size(), 0u);
  const auto hidden = Drawing(12).fill(0, 0, 3, 10).fill(0, -40, -1, 5).segments();
  ASSERT_EQ(hidden.size(), 1u);
  EXPECT_EQ(hidden[0].right, Side::occluded);
  EXPECT_EQ(hidden[0].left, Side::free);
}

TEST(Segments, TwoPolesAreTwoSlicesInOrderOfAzimuth) {
  const auto segments = Drawing(12).fill(0, 500, 502, 8).fill(0, 300, 304, 10).segments();
  ASSERT_EQ(segments.size(), 2u);
  EXPECT_EQ(segments[0].first, 300u);
  EXPECT_EQ(segments[1].first, 500u);
}

TEST(Segments, TwoPolesSideBySideAtDifferentRanges) {
  const auto segments = Drawing(14).fill(0, 300, 303, 10).fill(0, 304, 306, 11).segments();
  ASSERT_EQ(segments.size(), 2u);
  EXPECT_TRUE(segments[0].whole());
  EXPECT_EQ(segments[1].right, Side::occluded);
  EXPECT_EQ(segments[1].left, Side::free);
  EXPECT_FALSE(segments[1].whole());
}

TEST(Segments, AWideThingIsNone) {
  EXPECT_EQ(Drawing(14).fill(0, 300, 322, 10).segments().size(), 0u);  // 1.9 m
  EXPECT_EQ(Drawing(14).fill(0, 300, 310, 10).segments().size(), 1u);  // 0.87 m
  EXPECT_EQ(Drawing(14).fill(0, 300, 311, 10).segments().size(), 0u);  // 0.96 m
}

TEST(Segments, AThingDeeperThanAnyPoleIsNone) {
  Drawing receding(20);
  for (int s = 0; s < 8; ++s) receding.fill(0, 300 + s, 300 + s, 10 + 0.15 * s);  // 1.05 m deep
  EXPECT_EQ(receding.segments().size(), 0u);
}

TEST(Segments, HiddenOnBothSidesIsNone) {
  const Drawing between = Drawing(14).fill(0, 250, 350, 5).fill(0, 300, 304, 10);
  EXPECT_EQ(between.segments().size(), 0u);
}

TEST(Segments, AttachedOnOneSideIsNone) {
  EXPECT_EQ(Drawing(14).fill(0, 300, 304, 10).fill(0, 305, 360, 10.3).segments().size(), 0u);
  EXPECT_EQ(Drawing(14).fill(0, 300, 304, 10).fill(0, 240, 299, 10.3).segments().size(), 0u);
}

// A return between pole and wall also ends the pole; it is a segment of its own, half hidden.
TEST(Segments, AMixedPixelAtTheEdgeDoesNotAttach) {
  const auto left = poleBefore(12).fill(0, 305, 305, 10.25).segments();
  ASSERT_EQ(left.size(), 2u);
  EXPECT_EQ(left[0].count, 5u);
  EXPECT_TRUE(left[0].whole());
  EXPECT_EQ(left[1].first, 305u);
  EXPECT_EQ(left[1].right, Side::occluded);
  const auto right = poleBefore(12).fill(0, 299, 299, 10.25).segments();
  ASSERT_EQ(right.size(), 2u);
  EXPECT_EQ(right[0].left, Side::occluded);
  EXPECT_TRUE(right[1].whole());
}

TEST(Segments, OneMissingReturnIsBridged) {
  const auto segments = poleBefore(12).fill(0, 302, 302, 0).segments();
  ASSERT_EQ(segments.size(), 1u);
  EXPECT_EQ(segments[0].count, 4u);
  EXPECT_NEAR(segments[0].width(), 10 * 2 * kDegree, 1e-5);
}

TEST(Segments, ManyMissingReturnsDivide) {
  EXPECT_EQ(poleBefore(12).fill(0, 300, 310, 10).fill(0, 302, 307, 0).segments().size(), 2u);
}

// Close by, where firing steps are narrow, two or three missing returns are still bridged.
TEST(Segments, MissingReturnsAreBridgedFurtherCloseBy) {
  EXPECT_EQ(Drawing(6).fill(0, 300, 308, 3).fill(0, 303, 305, 0).segments().size(), 1u);
  EXPECT_EQ(Drawing(12).fill(0, 300, 308, 10).fill(0, 303, 305, 0).segments().size(), 2u);
}

TEST(Segments, ASingleReturnIsASlice) {
  const auto segments = Drawing(40).fill(0, 300, 300, 30).segments();
  ASSERT_EQ(segments.size(), 1u);
  EXPECT_EQ(segments[0].count, 1u);
  EXPECT_EQ(segments[0].width(), 0);
  EXPECT_NEAR(segments[0].rho, 30, 1e-4);
}

// The topmost beams often meet nothing but one lamp post.
TEST(Segments, TheOnlyReturnOfABeamIsASlice) {
  for (const int step : {0, 300, 719}) {
    const auto segments = Drawing(0).fill(0, step, step, 20).segments();
    ASSERT_EQ(segments.size(), 1u);
    EXPECT_EQ(segments[0].count, 1u);
    EXPECT_TRUE(segments[0].whole());
  }
}

TEST(Segments, AClosedRingHasNone) {
  EXPECT_EQ(Drawing(10).segments().size(), 0u);
}

TEST(Segments, EmptyRowsHaveNone) {
  EXPECT_EQ(Drawing(0).segments().size(), 0u);
}

TEST(Segments, RowsAreTakenFromTheTop) {
  const auto segments = Drawing(0).fill(1, 100, 102, 9).fill(0, 400, 402, 9).segments();
  ASSERT_EQ(segments.size(), 2u);
  EXPECT_EQ(segments[0].row, 0);
  EXPECT_EQ(segments[1].row, 1);
}

// A scan turned by any number of firing steps gives the same segments, wherever the seam falls.
TEST(Segments, TurningTheScanTurnsTheSlices) {
  Drawing drawing(14);
  drawing.fill(0, 300, 304, 10).fill(0, 302, 302, 0);      // a hole
  drawing.fill(0, 320, 328, 3).fill(0, 323, 325, 0);       // a wide hole, bridged
  drawing.fill(0, 340, 342, 10).fill(0, 343, 343, 10.25);  // a mixed pixel
  drawing.fill(0, 360, 362, 8).fill(0, 363, 364, 9);       // one hides the other's side
  drawing.fill(0, 380, 380, 13).fill(0, 390, 400, 0);      // a single return; nothing behind
  drawing.fill(0, 394, 396, 12);
  const auto before = drawing.segments();
  ASSERT_EQ(before.size(), 8u);
  for (int steps = 1; steps < Drawing::kSteps; ++steps) {
    const auto after = drawing.turned(steps).segments();
    ASSERT_EQ(after.size(), before.size()) << steps;
    std::size_t matched = 0;
    for (const ScanLineSegment& a : before) {
      const double angle = steps * 0.5 * kDegree;
      const double x = a.x * std::cos(angle) - a.y * std::sin(angle);
      const double y = a.x * std::sin(angle) + a.y * std::cos(angle);
      for (const ScanLineSegment& b : after)
        matched += std::hypot(b.x - x, b.y - y) < 1e-4 && a.count == b.count && a.left == b.left &&
                   a.right == b.right && std::abs(a.width() - b.width()) < 1e-4;
    }
    ASSERT_EQ(matched, before.size()) << steps;
  }
}

}  // namespace
}  // namespace polemcl::test_scan_line_segmenter
