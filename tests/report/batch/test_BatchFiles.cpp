#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>

#include <polemcl/core/common/Types.h>
#include "io/file/CsvTable.h"
#include "io/file/TextFile.h"
#include "report/batch/BatchFiles.h"
#include "report/batch/BatchSummary.h"
#include "support/SampleBatches.h"
#include "support/TempFolder.h"

namespace polemcl::report::test_batch_files {
namespace {

using testing_apps::readText;
using testing_apps::TempFolder;
using testing_apps::writeText;

nlohmann::json jsonOf(const BatchResults& batch) {
  const TempFolder folder;
  writeResultsJson(folder / "a.json", batch);
  return nlohmann::json::parse(readText(folder / "a.json"));
}

}  // namespace

TEST(BatchFiles, JsonHoldsAllThatTheBatchTells) {
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
  EXPECT_EQ(runs[1]["failure"], "disk full, \"really\"");
  EXPECT_TRUE(json["results"][2]["runs"][1]["health"]["first_pose_scan"].is_null());
  const auto& plots = json["results"][0]["plots"];
  EXPECT_EQ(plots["map_poles_xy"], nlohmann::json({1, 2, -3.25, 4, 50, -20}));
  EXPECT_EQ(plots["estimate_xy"], nlohmann::json({0, 0.1, 40.2, 0, 40, 29.9}));
  EXPECT_EQ(plots["position_largest_m"], nlohmann::json({0.1, nullptr, 0.35, 0.2}));
  EXPECT_EQ(plots["heading_histogram"], nlohmann::json(smallPlots().headingErrors.counts));
  EXPECT_EQ(json["failures"][0]["log"], "logs/a<b.log");
}

TEST(BatchFiles, TheReportIsTestedOnTheSampleBatch) {
  // tests/report/batch/test_report.py reads this file.
  const std::string sample = std::string(POLEMCL_SOURCE_DIR) + "/tests/report/batch/sample.json";
  if (std::getenv("POLEMCL_WRITE_PAGES")) writeResultsJson(sample, scoredBatch());
  const TempFolder folder;
  writeResultsJson(folder / "a.json", scoredBatch());
  EXPECT_EQ(readText(folder / "a.json"), readText(sample))
      << "write it anew with POLEMCL_WRITE_PAGES=1";
}

TEST(BatchFiles, JsonHoldsScoresAndPublishedSessions) {
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
  EXPECT_EQ(json["summary"][0]["scored_maps"], 1);
  EXPECT_EQ(json["summary"][0]["map_score"]["near_1m"]["recall"], 0.6);
}

TEST(BatchFiles, MapsAsATable) {
  const TempFolder folder;
  writeMapsCsv(folder / "maps.csv", scoredBatch());
  const io::CsvTable table(folder / "maps.csv");
  ASSERT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.text(0, table.column("setting")), "plain");
  EXPECT_EQ(table.text(0, table.column("session")), "three");
  EXPECT_EQ(table.text(0, table.column("truth")), "truth.csv");
  EXPECT_EQ(table.number(0, table.column("truth_poles")), 10);
  EXPECT_EQ(table.number(0, table.column("near_1m_precision")), 0.75);
  EXPECT_EQ(table.number(0, table.column("one_to_one_1m_matches")), 5);
  EXPECT_EQ(table.number(0, table.column("one_to_one_0.5m_recall")), 0.4);
  EXPECT_EQ(table.number(1, table.column("near_1m_recall")), 0.8);
  writeMapsCsv(folder / "none.csv", smallBatch());
  EXPECT_EQ(io::readLines(folder / "none.csv").size(), 1u);
}

TEST(BatchFiles, ScriptsFindTheSummaries) {
  const auto json = jsonOf(smallBatch());
  const auto& plain = json["summary"][0];
  EXPECT_EQ(plain["setting"], "plain");
  EXPECT_EQ(plain["lost"], 2);
  EXPECT_NEAR(plain["figures"]["pos_mean"]["mean"], 4.6 / 3, 1e-12);
  EXPECT_NEAR(plain["sessions"][0]["figures"]["ang_mean_deg"]["mean"], 0.3, 1e-12);
  EXPECT_TRUE(json["summary"][1]["last_over_first"].is_null());
  EXPECT_EQ(json["results"][2]["runs"][1]["state"], "lost");
}

TEST(BatchFiles, RunsAsATable) {
  const TempFolder folder;
  writeRunsCsv(folder / "runs.csv", smallBatch());
  EXPECT_EQ(io::readLines(folder / "runs.csv")[4],
            "plain,two_2,1,1001,failed,\"disk full, \"\"really\"\"\",,,,,,,,,,,,,,0,0,,,,,0");
  const io::CsvTable table(folder / "runs.csv");
  ASSERT_EQ(table.rows(), 7u);
  EXPECT_EQ(table.text(0, table.column("session")), "one<&\">");
  EXPECT_EQ(table.text(5, table.column("state")), "lost");
  EXPECT_EQ(table.number(2, table.column("pos_rmse")), 0.8);
  EXPECT_EQ(table.number(2, table.column("first_pose_scan")), 0);
  EXPECT_EQ(table.text(6, table.column("setting")), "up_keep 100 %");
}

TEST(BatchFiles, SessionsAsATable) {
  const TempFolder folder;
  writeSessionsCsv(folder / "sessions.csv", smallBatch());
  const io::CsvTable table(folder / "sessions.csv");
  ASSERT_EQ(table.rows(), 4u);
  EXPECT_NEAR(table.number(0, table.column("pos_mean")), 0.2, 1e-8);
  EXPECT_NEAR(table.number(0, table.column("pos_mean_sd")), std::sqrt(0.02), 1e-8);
  EXPECT_EQ(table.text(1, table.column("pos_mean_sd")), "");
  EXPECT_EQ(table.number(1, table.column("failed")), 1);
  EXPECT_EQ(table.text(1, table.column("length_m")), "");
  EXPECT_EQ(table.number(3, table.column("f_map")), 0);
}

TEST(BatchFiles, NoFigureIsNeverPrinted) {
  const TempFolder folder;
  writeRunsCsv(folder / "runs.csv", smallBatch());
  writeSessionsCsv(folder / "sessions.csv", smallBatch());
  writeResultsJson(folder / "results.json", smallBatch());
  const std::regex notANumber("\\b(nan|inf)\\b", std::regex::icase);
  for (const std::string& name : testing_apps::names(folder.path()))
    EXPECT_FALSE(std::regex_search(readText(folder / name), notANumber)) << name;
}

}  // namespace polemcl::report::test_batch_files
