#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/extraction/scan_line/SegmentClustering.h"
#include "support/Clouds.h"
#include "support/Sensors.h"

namespace polemcl::test_segment_clustering {
namespace {

using namespace polemcl::clouds;

SensorModel sensorModel(const std::string& model = "hdl64e") {
  return SensorModel(tests::sensorNamed(model));
}

/// What a beam sees of a thin pole at (x, y).
ScanLineSegment segmentAt(const SensorModel& sensor, int row, double x, double y) {
  ScanLineSegment s;
  s.row = row;
  s.rho = static_cast<float>(std::hypot(x, y));
  s.x = static_cast<float>(x);
  s.y = static_cast<float>(y);
  s.z = static_cast<float>(s.rho * sensor.beam(row).slope + sensor.beam(row).offset);
  s.count = 3;
  return s;
}

/// In the order ScanLineSegmenter gives them.
void sortByRow(std::vector<ScanLineSegment>& segments) {
  std::stable_sort(
      segments.begin(), segments.end(),
      [](const ScanLineSegment& a, const ScanLineSegment& b) { return a.row < b.row; });
}

using Lists = std::vector<std::vector<std::uint32_t>>;

Lists cluster(const SensorModel& sensor, std::vector<ScanLineSegment> segments,
              const ScanLineOptions& options = {}) {
  sortByRow(segments);
  SegmentClustering stacker(sensor, options);
  Lists lists;
  for (const SegmentCluster& s : stacker.cluster(segments)) {
    lists.emplace_back(s.begin(), s.end());
    EXPECT_EQ(s.top(), lists.back().front());
    EXPECT_EQ(s.bottom(), lists.back().back());
  }
  return lists;
}

std::vector<ScanLineSegment> pole(const SensorModel& sensor, int firstRow, int lastRow, double x,
                                  double y) {
  std::vector<ScanLineSegment> segments;
  for (int row = firstRow; row <= lastRow; ++row) segments.push_back(segmentAt(sensor, row, x, y));
  return segments;
}

void append(std::vector<ScanLineSegment>& segments, const std::vector<ScanLineSegment>& more) {
  segments.insert(segments.end(), more.begin(), more.end());
}

/// The rule as it is stated: every segment joins the nearest cluster above it whose last segment
/// lies within reach, in the plane and in height. Looks at all clusters for every segment.
Lists bruteForce(const SensorModel& sensor, const std::vector<ScanLineSegment>& segments,
                 const ScanLineOptions& options) {
  Lists clusters;
  for (std::uint32_t i = 0; i < segments.size(); ++i) {
    const ScanLineSegment& s = segments[i];
    const double gap = std::max(options.stackGap, 2.2 * sensor.spacingAbove(s.row) * s.rho);
    std::size_t best = clusters.size();
    double bestDistance = options.stackReach;
    for (std::size_t k = 0; k < clusters.size(); ++k) {
      const ScanLineSegment& last = segments[clusters[k].back()];
      const double distance = std::hypot(last.x - s.x, last.y - s.y);
      if (last.row == s.row || last.z - s.z > gap || distance >= bestDistance) continue;
      best = k;
      bestDistance = distance;
    }
    if (best == clusters.size()) clusters.emplace_back();
    clusters[best].push_back(i);
  }
  clusters.erase(std::remove_if(clusters.begin(), clusters.end(),
                                [](const auto& list) { return list.size() < 2; }),
                 clusters.end());
  return clusters;
}

TEST(SegmentClustering, APoleIsOneStackFromTheTop) {
  const SensorModel sensor = sensorModel();
  EXPECT_EQ(cluster(sensor, pole(sensor, 10, 14, 8, -6)), (Lists{{0, 1, 2, 3, 4}}));
}

TEST(SegmentClustering, ALoneSliceIsNone) {
  const SensorModel sensor = sensorModel();
  EXPECT_TRUE(cluster(sensor, {}).empty());
  EXPECT_TRUE(cluster(sensor, {segmentAt(sensor, 5, 10, 0)}).empty());
  EXPECT_TRUE(cluster(sensor, {segmentAt(sensor, 5, 10, 0), segmentAt(sensor, 6, 10, 3)}).empty());
}

TEST(SegmentClustering, TwoPolesSixtyCentimetresApartAreTwo) {
  const SensorModel sensor = sensorModel();
  std::vector<ScanLineSegment> segments = pole(sensor, 10, 13, 10, 0.3);
  append(segments, pole(sensor, 10, 13, 10, -0.3));
  // Sorted by row, the two alternate.
  EXPECT_EQ(cluster(sensor, segments), (Lists{{0, 2, 4, 6}, {1, 3, 5, 7}}));
}

TEST(SegmentClustering, TwoSlicesOfOneBeamAreNeverOneStack) {
  const SensorModel sensor = sensorModel();
  EXPECT_TRUE(
      cluster(sensor, {segmentAt(sensor, 5, 10, 0), segmentAt(sensor, 5, 10, 0.1)}).empty());
}

TEST(SegmentClustering, TheNearestStackTakesTheSlice) {
  const SensorModel sensor = sensorModel();
  const Lists lists =
      cluster(sensor, {segmentAt(sensor, 5, 10, 0.2), segmentAt(sensor, 5, 10, -0.2),
                       segmentAt(sensor, 6, 10, -0.05)});
  EXPECT_EQ(lists, (Lists{{1, 2}}));
}

TEST(SegmentClustering, ReachIsASetting) {
  const SensorModel sensor = sensorModel();
  const std::vector<ScanLineSegment> apart = {segmentAt(sensor, 5, 10, 0),
                                              segmentAt(sensor, 6, 10, 0.31)};
  EXPECT_TRUE(cluster(sensor, apart).empty());
  ScanLineOptions options;
  options.stackReach = 0.32;
  EXPECT_EQ(cluster(sensor, apart, options).size(), 1u);
}

TEST(SegmentClustering, AMissingRowIsBridged) {
  const SensorModel sensor = sensorModel();
  std::vector<ScanLineSegment> segments = pole(sensor, 10, 11, 12, 5);
  append(segments, pole(sensor, 13, 14, 12, 5));
  EXPECT_EQ(cluster(sensor, segments).size(), 1u);
}

TEST(SegmentClustering, WhatIsFarAboveIsAnotherThing) {
  const SensorModel sensor = sensorModel();
  // At 10 m the upper block's beams are 6 cm apart: 10 rows are 0.6 m, 25 rows 1.5 m.
  std::vector<ScanLineSegment> near = pole(sensor, 0, 1, 10, 0), far = near;
  append(near, pole(sensor, 11, 12, 10, 0));
  append(far, pole(sensor, 26, 27, 10, 0));
  EXPECT_EQ(cluster(sensor, near).size(), 1u);
  EXPECT_EQ(cluster(sensor, far).size(), 2u);
  ScanLineOptions options;
  options.stackGap = 2;
  EXPECT_EQ(cluster(sensor, far, options).size(), 1u);
}

// Beams of a VLP-16 are 0.7 m apart at 20 m and 1.2 m at 35 m: the next always counts, and one
// silent beam between is bridged, two are not.
TEST(SegmentClustering, WideBeamsFarAway) {
  const SensorModel sensor = sensorModel("vlp16");
  for (const double rho : {20.0, 35.0}) {
    EXPECT_EQ(cluster(sensor, pole(sensor, 5, 9, rho, 0)), (Lists{{0, 1, 2, 3, 4}})) << rho;
    EXPECT_EQ(cluster(sensor, {segmentAt(sensor, 5, rho, 0), segmentAt(sensor, 7, rho, 0)}).size(),
              1u);
    EXPECT_TRUE(
        cluster(sensor, {segmentAt(sensor, 5, rho, 0), segmentAt(sensor, 8, rho, 0)}).empty());
  }
}

TEST(SegmentClustering, ATiltedPoleIsOne) {
  const SensorModel sensor = sensorModel("vlp16");
  std::vector<ScanLineSegment> segments;
  for (int row = 4; row < 12; ++row) {
    ScanLineSegment s = segmentAt(sensor, row, 10, 0);
    s.y = s.z * std::tan(0.3f);  // 0.35 m between beams, 11 cm to the side each
    segments.push_back(s);
  }
  EXPECT_EQ(cluster(sensor, segments).size(), 1u);
  EXPECT_EQ(cluster(sensor, segments)[0].size(), 8u);
}

TEST(SegmentClustering, StacksComeInTheOrderOfTheirTops) {
  const SensorModel sensor = sensorModel();
  std::vector<ScanLineSegment> segments = pole(sensor, 20, 22, -10, 0);
  append(segments, pole(sensor, 10, 12, 10, 0));
  append(segments, pole(sensor, 15, 21, 0, 10));
  const Lists lists = cluster(sensor, segments);
  ASSERT_EQ(lists.size(), 3u);
  EXPECT_LT(lists[0][0], lists[1][0]);
  EXPECT_LT(lists[1][0], lists[2][0]);
  EXPECT_EQ(lists[1].size(), 7u);
}

TEST(SegmentClustering, EqualsABruteForceOnRandomSlices) {
  for (const std::string model : {"vlp16", "hdl64e"}) {
    const SensorModel sensor = sensorModel(model);
    ScanLineOptions options;
    SegmentClustering stacker(sensor, options);
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      sim::Random random(seed);
      std::vector<ScanLineSegment> segments;
      const double extent = seed % 3 ? 3 : 28;  // crowded, or to the end of the range
      for (int i = 0; i < 600; ++i)
        segments.push_back(segmentAt(sensor, random.below(sensor.beamCount()),
                                     random.uniform(-extent, extent),
                                     random.uniform(-extent, extent)));
      sortByRow(segments);
      Lists found;
      for (const SegmentCluster& s : stacker.cluster(segments))
        found.emplace_back(s.begin(), s.end());
      ASSERT_EQ(found, bruteForce(sensor, segments, options)) << model << ' ' << seed;
    }
  }
}

TEST(SegmentClustering, AllAroundTheSensorNearAndFar) {
  const SensorModel sensor = sensorModel("hdl32e");
  for (const double rho : {0.05, 1.0, 39.9})
    for (double azimuth = -M_PI; azimuth < M_PI; azimuth += 0.01) {
      const double x = rho * std::cos(azimuth), y = rho * std::sin(azimuth);
      ASSERT_EQ(
          cluster(sensor, {segmentAt(sensor, 8, x, y), segmentAt(sensor, 9, x * 1.002, y)}).size(),
          1u)
          << rho << ' ' << azimuth;
    }
}

}  // namespace
}  // namespace polemcl::test_segment_clustering
