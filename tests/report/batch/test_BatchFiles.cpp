#include <gtest/gtest.h>

#include <cmath>
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

/// Every row has as many cells as its table has columns.
void expectFullRows(const std::filesystem::path& file) {
  const std::regex begin(R"(\\begin\{tabular\}\{([lr]+)\})");
  std::size_t columns = 0;
  for (const std::string& line : io::readLines(file)) {
    std::smatch match;
    if (std::regex_search(line, match, begin)) columns = match[1].length();
    if (line.size() < 3 || line.substr(line.size() - 3) != " \\\\") continue;
    std::size_t cells = 1;
    for (std::size_t i = 1; i < line.size(); ++i) cells += line[i] == '&' && line[i - 1] != '\\';
    EXPECT_EQ(cells, columns) << line;
  }
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

TEST(BatchFiles, LatexShowsEveryLetter) {
  EXPECT_EQ(latexText("a_b & 5 % #1 $x$ {y}"), "a\\_b \\& 5 \\% \\#1 \\$x\\$ \\{y\\}");
  EXPECT_EQ(latexText("\\~^<>|"),
            "\\textbackslash{}\\textasciitilde{}\\textasciicircum{}\\textless{}\\textgreater{}"
            "\\textbar{}");
  EXPECT_EQ(latexText("--jobs ''"), "-{}-jobs '{}'");
  EXPECT_EQ(latexText("two\nlines"), "two lines");
}

TEST(BatchFiles, LatexTableHoldsThePapersColumns) {
  const TempFolder folder;
  BatchResults batch = smallBatch();
  batch.dataset = "mulran-kaist";
  writeLatexTable(folder / "table.tex", batch);
  const std::string text = readText(folder / "table.tex");
  EXPECT_NE(text.find("one\\textless{}\\&\"\\textgreater{} & 100.0 & $0.200 \\pm 0.141$ & "
                      "$0.400 \\pm 0.283$ & $0.300 \\pm 0.141$ & $0.600 \\pm 0.283$ \\\\\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("two\\_2 & 25.0 & 0.400 & 0.800 & 0.800 & 1.600 \\\\\n"), std::string::npos);
  EXPECT_NE(
      text.find("3 sessions, 2 runs of each, 2 wrong, 1 failed. paper: own data in the map.}"),
      std::string::npos);
  EXPECT_NE(text.find("published results and those of this batch. Published: Evaluated at every"),
            std::string::npos);
  EXPECT_NE(text.find("This batch: \\emph{plain}: 3 sessions, 2 runs of each, 2 wrong, 1 failed. "
                      "paper: own data in the map. \\emph{up\\_keep 100 \\%}: 1 session, 1 run.}"),
            std::string::npos);
  EXPECT_NE(text.find("Dong et al. 2021 & -- & 48.0 & 0.270 \\\\\n"), std::string::npos);
  EXPECT_NE(text.find("polemcl, up\\_keep 100 \\% & 0.400 & 7.1 & 1.000 \\\\\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find("$\\mathrm{RMSE}_\\mathrm{axis}$ [cm]"), std::string::npos);
  EXPECT_NE(text.find("$\\mathrm{RMSE}_\\mathrm{pos}$ [m]"), std::string::npos);
  expectFullRows(folder / "table.tex");
}

TEST(BatchFiles, LatexTablesHoldScoresAndPublishedSessions) {
  const TempFolder folder;
  BatchResults batch = scoredBatch();
  batch.dataset = "nclt";
  writeLatexTable(folder / "table.tex", batch);
  const std::string text = readText(folder / "table.tex");
  const auto expectRow = [&](const std::string& row) {
    EXPECT_NE(text.find("    " + row + " \\\\\n"), std::string::npos) << row << " is not in\n"
                                                                      << text;
  };
  expectRow("Dong et al. 2021 & 0.525 & 0.713 & 0.605 & -- & -- & -- & -- & -- & --");
  EXPECT_NE(text.find("This batch: \\emph{plain}: 1 map. paper: own data in the map. "
                      "\\emph{up\\_keep 100 \\%}: 1 map.}"),
            std::string::npos);
  expectRow(
      "polemcl, plain & 0.750 & 0.600 & 0.667 & 0.625 & 0.500 & 0.556 & 0.500 & 0.400 & 0.444");
  expectRow(
      "two\\_2 & 25.0 & 0.400 & 0.120 & 0.130 & 0.800 & 0.146 & 0.178 & 0.800 & 0.626 & 0.663 & "
      "1.600 & 0.810 & 0.857");
  expectFullRows(folder / "table.tex");
}

TEST(BatchFiles, NoFigureIsNeverPrinted) {
  const TempFolder folder;
  writeRunsCsv(folder / "runs.csv", smallBatch());
  writeSessionsCsv(folder / "sessions.csv", smallBatch());
  writeLatexTable(folder / "table.tex", smallBatch());
  writeResultsJson(folder / "results.json", smallBatch());
  const std::regex notANumber("\\b(nan|inf)\\b", std::regex::icase);
  for (const std::string& name : testing_apps::names(folder.path()))
    EXPECT_FALSE(std::regex_search(readText(folder / name), notANumber)) << name;
}

}  // namespace polemcl::report::test_batch_files
