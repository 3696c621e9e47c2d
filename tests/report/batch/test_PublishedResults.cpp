#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include <polemcl/core/common/Types.h>
#include "report/batch/PublishedResults.h"
#include "support/TempFolder.h"

namespace polemcl::report::test_published_results {
namespace {

/// Rows as they stand in the papers' tables, "-" for no figure.
void expectFigures(const std::string& key, const std::string& table,
                   const std::vector<double PublishedResult::*>& columns) {
  const PublishedDataset* dataset = publishedResults(key);
  ASSERT_NE(dataset, nullptr);
  std::istringstream rows(table);
  std::string name, word;
  for (const PublishedResult& system : dataset->figures) {
    ASSERT_TRUE(rows >> name);
    EXPECT_EQ(system.system.rfind(name, 0), 0u) << system.system << " is not " << name;
    for (double PublishedResult::*column : columns) {
      ASSERT_TRUE(rows >> word) << name;
      if (word == "-")
        EXPECT_TRUE(std::isnan(system.*column)) << name;
      else
        EXPECT_EQ(system.*column, std::stod(word)) << name;
    }
  }
  EXPECT_FALSE(rows >> name) << "a system is missing: " << name;
}

using P = PublishedResult;

}  // namespace

TEST(PublishedResults, OfNclt) {
  expectFigures(
      "nclt",
      "Schaefer 0.284 0.526 0.801 1.081 - -\n"
      "Dong     0.174 0.293 0.761 1.016 - -\n",
      {&P::posMean, &P::posRmse, &P::angMeanDeg, &P::angRmseDeg, &P::axisRmse, &P::latStd});
}

TEST(PublishedResults, OfKitti) {
  expectFigures("kitti-0009",
                "Kümmerle 0.12  -     0.07  -     0.08  -     0.33  -     -\n"
                "Weng     -     -     -     0.082 -     0.164 -     0.329 -\n"
                "Sefati   -     0.24  -     -     -     -     -     -     0.68\n"
                "Schaefer 0.096 0.111 0.061 0.075 0.060 0.067 0.133 0.188 0.214\n"
                "Dong     0.091 0.106 0.066 0.067 0.046 0.058 0.084 0.102 0.102\n",
                {&P::posMean, &P::posRmse, &P::latMean, &P::latStd, &P::lonMean, &P::lonStd,
                 &P::angMeanDeg, &P::angStdDeg, &P::angRmseDeg});
}

TEST(PublishedResults, OfMulranPerAxis) {
  expectFigures("mulran-kaist",
                "Schaefer 1.82 0.56 - -\n"
                "Chen     0.83 3.14 - -\n"
                "Dong     0.48 0.27 - -\n",
                {&P::axisRmse, &P::angRmseDeg, &P::posRmse, &P::posMean});
}

TEST(PublishedResults, PositionsAreConsistentWithTheirComponents) {
  // A mean of hypotenuses is at most the sum of the means of the sides, at least the larger.
  for (const PublishedDataset& dataset : publishedDatasets())
    for (const PublishedResult& system : dataset.figures) {
      EXPECT_FALSE(system.posMean > system.posRmse) << system.system;
      EXPECT_FALSE(system.angMeanDeg > system.angRmseDeg) << system.system;
      EXPECT_FALSE(system.posMean > system.latMean + system.lonMean) << system.system;
    }
}

TEST(PublishedResults, ScoresOfMaps) {
  const auto expectScores = [](const std::string& key, const std::vector<double>& figures) {
    const PublishedDataset* dataset = publishedResults(key);
    ASSERT_NE(dataset, nullptr);
    ASSERT_EQ(dataset->maps.size(), 2u);
    EXPECT_FALSE(dataset->mapProtocol.empty());
    std::vector<double> all;
    for (const PublishedMapScore& map : dataset->maps)
      all.insert(all.end(), {map.precision, map.recall, map.f1});
    EXPECT_EQ(all, figures);
    EXPECT_EQ(dataset->maps[0].system.rfind("Schaefer", 0), 0u);
    EXPECT_EQ(dataset->maps[1].system.rfind("Dong", 0), 0u);
  };
  expectScores("nclt", {0.518, 0.664, 0.582, 0.525, 0.713, 0.605});
  expectScores("semantickitti", {0.621, 0.380, 0.455, 0.687, 0.439, 0.515});
  EXPECT_TRUE(publishedResults("kitti-0009")->maps.empty());
}

TEST(PublishedResults, SessionsOfNcltAgreeWithTheirMeans) {
  const auto published =
      readPublishedSessions(std::string(POLEMCL_SOURCE_DIR) + "/share/published/nclt-table3.csv");
  const PublishedDataset* dataset = publishedResults("nclt");
  ASSERT_EQ(publishedSystems(published),
            (std::vector<std::string>{"Dong et al. 2021", "Schaefer et al. 2019"}));
  for (const PublishedResult& system : dataset->figures) {
    PublishedSession mean{system.system, "", 0, 0, 0, 0, 0};
    std::size_t sessions = 0;
    for (const PublishedSession& one : published) {
      if (one.system != system.system) continue;
      ++sessions;
      mean.posMean += one.posMean / 27, mean.posRmse += one.posRmse / 27;
      mean.angMeanDeg += one.angMeanDeg / 27, mean.angRmseDeg += one.angRmseDeg / 27;
    }
    EXPECT_EQ(sessions, 27u);
    // To half of the last digit, and what rounding each of 27 figures may add.
    EXPECT_NEAR(mean.posMean, system.posMean, 0.0007) << system.system;
    EXPECT_NEAR(mean.posRmse, system.posRmse, 0.0007) << system.system;
    EXPECT_NEAR(mean.angMeanDeg, system.angMeanDeg, 0.0007) << system.system;
    EXPECT_NEAR(mean.angRmseDeg, system.angRmseDeg, 0.0007) << system.system;
  }
  const PublishedSession* last = find(published, "Dong et al. 2021", "2013-02-23");
  ASSERT_NE(last, nullptr);
  EXPECT_EQ(last->posRmse, 0.567);
  EXPECT_EQ(last->mapShare, 0);
  EXPECT_EQ(find(published, "Dong et al. 2021", "2012-02-23"), nullptr);
}

TEST(PublishedResults, RefusesTablesThatAreDamaged) {
  const testing_apps::TempFolder folder;
  const auto refusal = [&](const std::string& text) {
    testing_apps::writeText(folder / "a.csv", text);
    try {
      readPublishedSessions(folder / "a.csv");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const std::string head = "system,session,f_map,pos_mean,pos_rmse,ang_mean_deg,ang_rmse_deg\n";
  EXPECT_EQ(refusal(head + "A,s,,1,2,3,4\n"), "no error");
  EXPECT_NE(refusal("system,session,f_map,pos_mean\nA,s,1,2\n")
                .find("a.csv: columns are missing: pos_rmse,ang_mean_deg,ang_rmse_deg; the first "
                      "line must name system,session,f_map,"),
            std::string::npos);
  EXPECT_NE(refusal(head + "A,s,,x,2,3,4\n").find("a.csv:2: "), std::string::npos);
  EXPECT_NE(refusal(head + "A,s,,1,2,3,4\nA,s,,1,2,3,4\n").find("a.csv:3: session s of A"),
            std::string::npos);
}

TEST(PublishedResults, OtherBatchesHaveNone) {
  EXPECT_EQ(publishedResults(""), nullptr);
  EXPECT_EQ(publishedResults("year"), nullptr);
}

}  // namespace polemcl::report::test_published_results
