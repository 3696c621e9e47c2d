#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "io/file/AtomicFile.h"
#include "report/batch/BatchJson.h"
#include "support/SampleBatches.h"
#include "support/TempFolder.h"

namespace polemcl::report::test_batch_json {
namespace {
using testing_apps::readText;

nlohmann::json jsonOf(const BatchResults& batch) {
  return nlohmann::json::parse(resultsJson(batch));
}

TEST(BatchJson, HoldsAllThatTheBatchTells) {
  const BatchResults batch = smallBatch();
  const auto json = jsonOf(batch);
  EXPECT_EQ(json["format_version"], 2);
  EXPECT_EQ(json["title"], batch.title);
  EXPECT_EQ(json["command"], batch.command);
  EXPECT_EQ(json["versions"]["compiler"], "GCC 12.2");
  EXPECT_EQ(json["settings"][0]["config"], batch.configurations[0].config);
  EXPECT_EQ(json["sessions"][2]["length_m"], 1480.5);
  EXPECT_TRUE(json["sessions"][1]["length_m"].is_null());
  ASSERT_EQ(json["results"].size(), 4u);
  const auto& runs = json["results"][1]["runs"];
  const ErrorMetrics& errors = batch.results[1].runs[0].errors;
  EXPECT_EQ(runs[0]["errors"]["pos_rmse"], errors.posRmse);
  EXPECT_EQ(runs[0]["errors"]["y_rmse"], errors.yRmse);
  EXPECT_EQ(runs[0]["errors"]["unmatched"], 3);
  EXPECT_EQ(runs[0]["health"]["degraded"], 0.1);
  EXPECT_EQ(runs[0]["health"]["first_pose_scan"], 0);
  EXPECT_EQ(runs[0]["state"], "ok");
  EXPECT_EQ(runs[1]["failure"], "disk full, \"really\"");
  EXPECT_EQ(runs[1]["state"], "failed");
  EXPECT_EQ(json["results"][2]["runs"][1]["state"], "lost");
  EXPECT_TRUE(runs[1]["errors"]["pos_mean"].is_null());
  EXPECT_TRUE(json["results"][2]["runs"][1]["health"]["first_pose_scan"].is_null());
  const auto& plots = json["results"][0]["plots"];
  EXPECT_EQ(plots["map_poles_xy"], nlohmann::json({1, 2, -3.25, 4, 50, -20}));
  EXPECT_EQ(plots["estimate_xy"], nlohmann::json({0, 0.1, 40.2, 0, 40, 29.9}));
  EXPECT_EQ(plots["position_largest_m"], nlohmann::json({0.1, nullptr, 0.35, 0.2}));
  EXPECT_EQ(plots["heading_histogram"], nlohmann::json(smallPlots().headingErrors.counts));
  EXPECT_EQ(json["failures"][0]["log"], "logs/a<b.log");
}

TEST(BatchJson, TheReportIsTestedOnTheSampleBatch) {
  // tests/report/batch/test_report.py reads this file.
  const std::string sample = std::string(POLEMCL_SOURCE_DIR) + "/tests/report/batch/sample.json";
  if (std::getenv("POLEMCL_WRITE_PAGES")) io::writeFile(sample, resultsJson(scoredBatch()));
  EXPECT_EQ(resultsJson(scoredBatch()), readText(sample))
      << "write it anew with POLEMCL_WRITE_PAGES=1";
}

TEST(BatchJson, HoldsScoresAndPublishedSessions) {
  const auto json = jsonOf(scoredBatch());
  EXPECT_TRUE(json["results"][0]["map_score"].is_null());
  const auto& score = json["results"][2]["map_score"];
  EXPECT_EQ(score["truth"], "truth.csv");
  EXPECT_EQ(score["near_1m"]["matches"], 6);
  EXPECT_EQ(score["one_to_one_1m"]["precision"], 5 / 8.0);
  EXPECT_EQ(score["one_to_one_0.5m"]["truth_poles"], 10);
  ASSERT_EQ(json["published_sessions"].size(), 4u);
  EXPECT_EQ(json["published_sessions"][1]["session"], "three");
  EXPECT_EQ(json["published_sessions"][1]["pos_rmse"], 0.354);
  EXPECT_TRUE(json["published_sessions"][3]["f_map"].is_null());
}

// Names of files and what programs say need not be.
TEST(BatchJson, IsUtf8) {
  BatchResults batch = smallBatch();
  batch.failures[0].reason = "caf\xe9.bin: gone";
  EXPECT_EQ(jsonOf(batch)["failures"][0]["reason"], "caf\xef\xbf\xbd.bin: gone");
}

}  // namespace
}  // namespace polemcl::report::test_batch_json
