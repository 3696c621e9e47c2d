#include <gtest/gtest.h>
#include <polemcl/report/PublishedFigures.h>

#include <cmath>
#include <sstream>

namespace polemcl::report {
namespace {

/// Rows as they stand in the papers' tables, "-" for no figure.
void expectFigures(const std::string& key, const std::string& table,
                   const std::vector<double PublishedFigure::*>& columns) {
  const PublishedDataset* dataset = publishedFigures(key);
  ASSERT_NE(dataset, nullptr);
  std::istringstream rows(table);
  std::string name, word;
  for (const PublishedFigure& system : dataset->figures) {
    ASSERT_TRUE(rows >> name);
    EXPECT_EQ(system.system.rfind(name, 0), 0u) << system.system << " is not " << name;
    for (double PublishedFigure::*column : columns) {
      ASSERT_TRUE(rows >> word) << name;
      if (word == "-")
        EXPECT_TRUE(std::isnan(system.*column)) << name;
      else
        EXPECT_EQ(system.*column, std::stod(word)) << name;
    }
  }
  EXPECT_FALSE(rows >> name) << "a system is missing: " << name;
}

using P = PublishedFigure;

}  // namespace

TEST(PublishedFigures, OfNclt) {
  expectFigures(
      "nclt",
      "Schaefer 0.284 0.526 0.801 1.081 - -\n"
      "Dong     0.174 0.293 0.761 1.016 - -\n",
      {&P::posMean, &P::posRmse, &P::angMeanDeg, &P::angRmseDeg, &P::axisRmse, &P::latStd});
}

TEST(PublishedFigures, OfKitti) {
  expectFigures("kitti-0009",
                "Kümmerle 0.12  -     0.07  -     0.08  -     0.33  -     -\n"
                "Weng     -     -     -     0.082 -     0.164 -     0.329 -\n"
                "Sefati   -     0.24  -     -     -     -     -     -     0.68\n"
                "Schaefer 0.096 0.111 0.061 0.075 0.060 0.067 0.133 0.188 0.214\n"
                "Dong     0.091 0.106 0.066 0.067 0.046 0.058 0.084 0.102 0.102\n",
                {&P::posMean, &P::posRmse, &P::latMean, &P::latStd, &P::lonMean, &P::lonStd,
                 &P::angMeanDeg, &P::angStdDeg, &P::angRmseDeg});
}

TEST(PublishedFigures, OfMulranPerAxis) {
  expectFigures("mulran-kaist",
                "Schaefer 1.82 0.56 - -\n"
                "Chen     0.83 3.14 - -\n"
                "Dong     0.48 0.27 - -\n",
                {&P::axisRmse, &P::angRmseDeg, &P::posRmse, &P::posMean});
}

TEST(PublishedFigures, PositionsAreConsistentWithTheirComponents) {
  // A mean of hypotenuses is at most the sum of the means of the sides, at least the larger.
  for (const PublishedDataset& dataset : publishedDatasets())
    for (const PublishedFigure& system : dataset.figures) {
      EXPECT_FALSE(system.posMean > system.posRmse) << system.system;
      EXPECT_FALSE(system.angMeanDeg > system.angRmseDeg) << system.system;
      EXPECT_FALSE(system.posMean > system.latMean + system.lonMean) << system.system;
    }
}

TEST(PublishedFigures, OtherBatchesHaveNone) {
  EXPECT_EQ(publishedFigures(""), nullptr);
  EXPECT_EQ(publishedFigures("year"), nullptr);
}

}  // namespace polemcl::report
