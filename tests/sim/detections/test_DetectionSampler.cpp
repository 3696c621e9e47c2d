#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/common/GreedyAssignment.h"
#include "sim/detections/DetectionSampler.h"
#include "support/DetectionModels.h"

namespace polemcl::test_detection_sampler {
namespace {

using namespace polemcl::sim;
using testing_sim::plainModel;

class DetectionSamplerTest : public testing::Test {
 protected:
  DetectionSamplerTest() {
    m_options.world.length = 400;
    m_options.world.relief = 0;
  }
  /// Sampled scans, with the poles within 40 m of each that no house hides.
  void sample(const DetectionModel& model) {
    const World world = makeWorld(m_options.world);
    const Drive drive = makeDrive(world, m_options);
    const DetectionSampler sampler(model, world, m_options);
    const SightLines sight(world);
    for (std::size_t i = 0; i < drive.time.size(); ++i) {
      const Eigen::Isometry3d& T = drive.T_map_sensor[i];
      const Eigen::Vector2d sensor = T.translation().head<2>();
      scans.push_back(sampler.sample(i, T));
      truth.emplace_back();
      const auto blocks = sight.around(sensor, 40);
      for (const TruePole& pole : world.poles()) {
        const Eigen::Vector3d place(pole.x, pole.y, T.translation().z());
        if ((place.head<2>() - sensor).norm() < 40 &&
            !SightLines::blocked(blocks, sensor, place.head<2>()))
          truth.back().push_back((T.inverse() * place).head<2>());
      }
    }
  }
  static std::vector<Eigen::Vector2d> centres(const std::vector<PoleDetection>& poles) {
    std::vector<Eigen::Vector2d> result;
    for (const auto& pole : poles) result.emplace_back(pole.x, pole.y);
    return result;
  }
  SimulationOptions m_options;
  std::vector<std::vector<PoleDetection>> scans;
  std::vector<std::vector<Eigen::Vector2d>> truth;
};
TEST_F(DetectionSamplerTest, FindsPolesAsOftenAndAsFarOffAsTheModelSays) {
  sample(plainModel());
  double chances = 0, found = 0, along = 0, across = 0, sum = 0, detections = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    chances += static_cast<double>(truth[i].size());
    detections += static_cast<double>(scans[i].size());
    const auto places = centres(scans[i]);
    for (const AssignedPair& pair : greedyAssignment(truth[i], places, 0.3)) {
      const Eigen::Vector2d ray = truth[i][pair.first].normalized(),
                            error = places[pair.second] - truth[i][pair.first];
      found += 1;
      sum += error.dot(ray);
      along += std::pow(error.dot(ray), 2);
      across += error.squaredNorm() - std::pow(error.dot(ray), 2);
    }
  }
  ASSERT_GT(chances, 5000);
  EXPECT_EQ(found, detections) << "nothing is false, nothing is farther off than 6 sigma";
  EXPECT_NEAR(found / chances, 0.6, 0.02);
  EXPECT_NEAR(std::sqrt(along / found), 0.05, 0.0015);
  EXPECT_NEAR(std::sqrt(across / found), 0.05, 0.0015);
  EXPECT_NEAR(sum / found, 0, 0.003);
}

TEST_F(DetectionSamplerTest, ReportsTheCovarianceAlongTheRay) {
  DetectionModel model = plainModel();
  for (auto& own : model.classes) own.reported[0][0].fill(0.2);
  sample(model);
  std::size_t seen = 0;
  for (const auto& scan : scans)
    for (const PoleDetection& pole : scan) {
      const Eigen::Vector2d ray = Eigen::Vector2d(pole.x, pole.y).normalized();
      EXPECT_NEAR(std::sqrt(ray.dot(pole.covariance * ray)), 0.2, 0.01);
      EXPECT_NEAR(pole.covariance.determinant(), 0.04 * 0.0025, 1e-8);
      EXPECT_EQ(pole.confidence, 0.7);
      EXPECT_EQ(pole.points, 20u);
      ++seen;
    }
  EXPECT_GT(seen, 1000u);
}

TEST_F(DetectionSamplerTest, WhatLastsKeepsAPoleHiddenOrFoundForTheWholeDrive) {
  DetectionModel model = plainModel();
  model.poleVisibility.today[4] = 1;
  sample(model);
  std::size_t flips = 0, stays = 0;
  for (std::size_t i = 1; i < scans.size(); ++i) {
    const auto before = greedyAssignment(truth[i - 1], centres(scans[i - 1]), 0.3);
    stays += before.size();
    const auto now = greedyAssignment(truth[i], centres(scans[i]), 0.3);
    flips += now.size() > before.size() ? now.size() - before.size() : before.size() - now.size();
  }
  EXPECT_LT(static_cast<double>(flips), 0.05 * static_cast<double>(stays));
}

TEST_F(DetectionSamplerTest, IsBlindBehindHouses) {
  DetectionModel model = plainModel();
  for (auto& own : model.classes)
    if (!own.detected.empty()) own.detected = {1, 1};
  model.poleVisibility.always[4] = 1;
  sample(model);
  std::size_t visible = 0, found = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    visible += truth[i].size();
    found += scans[i].size();
  }
  EXPECT_EQ(found, visible);
}

TEST_F(DetectionSamplerTest, FalseDetectionsComeAsOftenAsTheModelSaysTimesTheFactor) {
  DetectionModel model = plainModel();
  for (auto& own : model.classes)
    if (!own.detected.empty()) own.detected = {0, 0};
  model.passing = 0.5;
  for (const double factor : {0.5, 1.0, 2.0}) {
    m_options.falseFactor = factor;
    scans.clear();
    sample(model);
    double count = 0;
    for (const auto& scan : scans) {
      for (const PoleDetection& pole : scan) EXPECT_NEAR(std::hypot(pole.x, pole.y), 15, 0.2);
      count += static_cast<double>(scan.size());
    }
    EXPECT_NEAR(count / static_cast<double>(scans.size()), 0.5 * factor, 0.12 * std::sqrt(factor));
  }
}

TEST_F(DetectionSamplerTest, LastingFalseObjectsStandOnAllDaysOrOnOne) {
  DetectionModel model = plainModel();
  model.clutterAlways = 0.05;
  model.clutterToday = 0.03;
  m_options.world.length = 1500;
  const auto placesOn = [&](int day, double factor) {
    m_options.world.day = day;
    std::set<std::pair<double, double>> places;
    for (const auto& object : placeClutter(model, makeWorld(m_options.world), factor))
      places.emplace(object.x, object.y);
    return places;
  };
  const auto first = placesOn(0, 1), second = placesOn(1, 1), twice = placesOn(1, 2);
  EXPECT_NEAR(static_cast<double>(first.size()), 0.08 * 1500, 4 * std::sqrt(0.08 * 1500));
  double common = 0;
  for (const auto& place : first) common += static_cast<double>(second.count(place));
  EXPECT_NEAR(common, 0.05 * 1500, 4 * std::sqrt(0.05 * 1500));
  EXPECT_NEAR(static_cast<double>(twice.size()), 0.16 * 1500, 4 * std::sqrt(0.16 * 1500));
  for (const auto& place : second) EXPECT_EQ(twice.count(place), 1u);
}

TEST_F(DetectionSamplerTest, RefusesAnotherLidarOrHeight) {
  const World world = makeWorld(m_options.world);
  m_options.sensor = "vlp16";
  EXPECT_THROW(DetectionSampler(plainModel(), world, m_options), Error);
  m_options.sensor = "hdl32e";
  EXPECT_NO_THROW(DetectionSampler(plainModel(), world, m_options));
  m_options.height = 1.8;
  EXPECT_THROW(DetectionSampler(plainModel(), world, m_options), Error);
}

TEST_F(DetectionSamplerTest, VisibilityRangesEndAtHousesInTheFrameOfTheClouds) {
  const World world = makeWorld(m_options.world);
  const Drive drive = makeDrive(world, m_options);
  const DetectionSampler sampler(plainModel(), world, m_options);
  const SightLines sight(world);
  std::size_t hidden = 0, all = 0;
  for (std::size_t i = 0; i < drive.time.size(); i += 40) {
    const Eigen::Isometry3d& T = drive.T_map_sensor[i];
    const std::vector<float> ranges = sampler.visibilityRange(T);
    ASSERT_EQ(ranges.size(), 256u);
    const Eigen::Vector2d sensor = T.translation().head<2>();
    const auto blocks = sight.around(sensor, 40);
    for (const TruePole& pole : world.poles()) {
      const Eigen::Vector2d place(pole.x, pole.y);
      const double range = (place - sensor).norm();
      if (range > 39) continue;
      const Eigen::Vector3d seen =
          T.inverse() * Eigen::Vector3d(pole.x, pole.y, T.translation().z());
      const double bearing = std::atan2(seen.y(), seen.x());
      const auto sector = static_cast<std::size_t>((bearing + M_PI) / (2 * M_PI) * 256);
      const bool blocked = SightLines::blocked(blocks, sensor, place);
      ++all;
      hidden += blocked;
      // Sectors are coarse: a sector crossed by an edge ends at the edge.
      if (blocked) {
        EXPECT_LT(ranges.at(sector), range + 0.3) << i << ' ' << pole.id;
      }
    }
    EXPECT_GT(*std::max_element(ranges.begin(), ranges.end()), 20) << "the street is open";
    for (const float range : ranges) EXPECT_EQ(range, std::floor(range * 2) / 2);
  }
  EXPECT_GT(hidden, 20u);
  EXPECT_GT(all, 2 * hidden);
}

/// Share of detections among all chances to see a pole of a class during a drive.
template <class Sort>
double shareSeen(const DetectionModel& model, const SimulationOptions& options, const Sort& isA) {
  const World world = makeWorld(options.world);
  const Drive drive = makeDrive(world, options);
  const DetectionSampler sampler(model, world, options);
  const SightLines sight(world), fences(world, Obstacle::mesh);
  double chances = 0, found = 0;
  for (std::size_t i = 0; i < drive.time.size(); i += 2) {
    const Eigen::Isometry3d& T = drive.T_map_sensor[i];
    const Eigen::Vector2d sensor = T.translation().head<2>();
    const auto scan = sampler.sample(i, T);
    const auto blocks = sight.around(sensor, 40), meshes = fences.around(sensor, 40);
    for (const TruePole& pole : world.poles()) {
      const Eigen::Vector2d place(pole.x, pole.y);
      if ((place - sensor).norm() > 39 || SightLines::blocked(blocks, sensor, place) ||
          !isA(world, pole, SightLines::blocked(meshes, sensor, place)))
        continue;
      const Eigen::Vector3d here =
          T.inverse() * Eigen::Vector3d(pole.x, pole.y, T.translation().z());
      ++chances;
      found += std::any_of(scan.begin(), scan.end(), [&](const PoleDetection& seen) {
        return std::hypot(seen.x - here.x(), seen.y - here.y()) < 0.3;
      });
    }
  }
  EXPECT_GT(chances, 300);
  return found / chances;
}
TEST_F(DetectionSamplerTest, SnowHidesPolesThatStandInIt) {
  DetectionModel model = plainModel();
  model.season.snow.fill(-4);
  m_options.world.dayOfYear = 15;
  const auto inSnow = [](const World& world, const TruePole& pole, bool) {
    return world.snowAt(pole.x, pole.y) > 0.4;
  };
  const auto outside = [](const World& world, const TruePole& pole, bool) {
    return world.snowAt(pole.x, pole.y) == 0;
  };
  EXPECT_LT(shareSeen(model, m_options, inSnow), 0.03);
  EXPECT_NEAR(shareSeen(model, m_options, outside), 0.6, 0.05);
  model.season.snow.fill(0);
  EXPECT_NEAR(shareSeen(model, m_options, inSnow), 0.6, 0.05);
}

TEST_F(DetectionSamplerTest, BottomsLieOnTheSnowAndElsewhereWhereTheModelHasThem) {
  DetectionModel model = plainModel();
  for (auto& own : model.classes)
    for (Quantiles& row : own.reported[static_cast<int>(Reported::bottom)]) row.fill(-0.2);
  sample(model);
  for (const auto& scan : scans)
    for (const PoleDetection& pole : scan) ASSERT_EQ(pole.bottom, -0.2);
  scans.clear();
  m_options.world.dayOfYear = 15;
  sample(model);
  double inSnow = 0, all = 0;
  for (const auto& scan : scans)
    for (const PoleDetection& pole : scan) {
      EXPECT_TRUE(pole.bottom == -0.2 || (pole.bottom > 0 && pole.bottom < 0.75)) << pole.bottom;
      inSnow += pole.bottom > 0.4;
      ++all;
    }
  EXPECT_GT(inSnow, 0.3 * all);
}

TEST_F(DetectionSamplerTest, BareTreesAreSeenMoreOften) {
  DetectionModel model = plainModel();
  model.season.bare = {0, 0, 0, 0.8};  // P(z < 0.253 + 0.8) = 0.854
  const auto trees = [](const World&, const TruePole& pole, bool) {
    return pole.kind == Kind::tree;
  };
  const auto others = [](const World&, const TruePole& pole, bool) {
    return pole.kind != Kind::tree;
  };
  m_options.world.dayOfYear = 15;
  EXPECT_NEAR(shareSeen(model, m_options, trees), 0.854, 0.03);
  EXPECT_NEAR(shareSeen(model, m_options, others), 0.6, 0.04);
  m_options.world.dayOfYear = 196;
  EXPECT_NEAR(shareSeen(model, m_options, trees), 0.6, 0.04);
  m_options.world.dayOfYear = 0;
  EXPECT_NEAR(shareSeen(model, m_options, trees), 0.6, 0.04);
}

TEST_F(DetectionSamplerTest, FencesOfMeshLetSomePolesThrough) {
  DetectionModel model = plainModel();
  model.season.fence = -1;  // P(z < 0.253 - 1) = 0.227
  m_options.world.buildingSites = 6;
  m_options.world.length = 800;
  const auto behind = [](const World&, const TruePole&, bool mesh) { return mesh; };
  const auto free = [](const World&, const TruePole&, bool mesh) { return !mesh; };
  EXPECT_NEAR(shareSeen(model, m_options, behind), 0.227, 0.06);
  EXPECT_NEAR(shareSeen(model, m_options, free), 0.6, 0.03);
}

TEST_F(DetectionSamplerTest, BuildingSitesLookLikePolesWhileTheyStand) {
  DetectionModel model = plainModel();
  model.season.siteClutter = 0.2;
  m_options.world.buildingSites = 5;
  m_options.world.length = 1000;
  double metres = 0, objects = 0;
  std::map<std::uint64_t, std::set<std::uint64_t>> known;  // by site
  for (const int day : {0, 10, 20, 150, 300}) {
    m_options.world.day = day;
    const World world = makeWorld(m_options.world);
    const auto clutter = placeClutter(model, world, 1);
    objects += static_cast<double>(clutter.size());
    std::size_t placed = 0;
    for (const BuildingSite& site : world.buildingSites()) {
      metres += site.to - site.from;
      std::set<std::uint64_t> here;
      for (const ClutterObject& object : clutter)
        for (const auto& place : site.kerb)
          if (std::hypot(place.x() - object.x, place.y() - object.y) < 0.6) here.insert(object.id);
      placed += here.size();
      const auto [before, isNew] = known.emplace(site.seed, here);
      EXPECT_EQ(before->second, here) << "the same on all days of the site";
    }
    EXPECT_EQ(placed, clutter.size()) << "all of it at fences";
  }
  EXPECT_GT(known.size(), 5u);
  EXPECT_NEAR(objects, 0.2 * metres, 4 * std::sqrt(2.5 * 0.2 * metres));
}

}  // namespace
}  // namespace polemcl::test_detection_sampler
