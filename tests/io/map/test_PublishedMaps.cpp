// Scores of the authors' own NCLT map, as published or recomputed by them and others.

#include "core/evaluation/MapEvaluation.h"
#include "io/map/PoleTables.h"
#include "support/TempFolder.h"

namespace polemcl::test_published_maps {
namespace {

class PublishedMaps : public testing::Test {
 protected:
  void SetUp() override {
    POLEMCL_NEEDS_DATA();
    const auto folder = testing_apps::dataFolder() / "published";
    truth = io::readPolePositions(folder / "nclt_truth.npz");
    map = io::readPolePositions(folder / "nclt_map_8_0.50_0.08.npz");
  }
  std::vector<Eigen::Vector2d> truth, map;
};

TEST_F(PublishedMaps, NcltTheAuthorsWay) {
  ASSERT_EQ(truth.size(), 1205u);
  ASSERT_EQ(map.size(), 1635u);
  const MapScore score = scoreMap(truth, map, 1.0, false);
  EXPECT_EQ(score.matches, 859u);
  EXPECT_NEAR(score.precision, 0.5254, 5e-5);
  EXPECT_NEAR(score.recall, 0.7129, 5e-5);
  EXPECT_NEAR(score.f1, 0.6049, 5e-5);
}

TEST_F(PublishedMaps, NcltOneToOne) {
  const MapScore metre = scoreMap(truth, map, 1.0, true);
  EXPECT_EQ(metre.matches, 815u);
  EXPECT_NEAR(metre.precision, 0.498, 5e-4);
  EXPECT_NEAR(metre.recall, 0.676, 5e-4);
  EXPECT_NEAR(metre.f1, 0.574, 5e-4);
  const MapScore half = scoreMap(truth, map, 0.5, true);
  EXPECT_NEAR(half.precision, 0.471, 5e-4);
  EXPECT_NEAR(half.recall, 0.639, 5e-4);
  EXPECT_NEAR(half.f1, 0.542, 5e-4);
}

}  // namespace
}  // namespace polemcl::test_published_maps
