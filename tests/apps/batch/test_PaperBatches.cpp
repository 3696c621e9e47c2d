#include <polemcl/core/common/Types.h>
#include "batch/BatchApp.h"
#include "io/file/TextFile.h"
#include "support/BatchTestFiles.h"
#include "support/StreetDatasets.h"

namespace polemcl::test_paper_batches {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

/// The batches of the paper's tables, from config/batches/, on short simulated drives in the format
/// of each dataset. They are cut down to fewer sessions and one run, and nothing else.
class PaperBatches : public testing::Test {
 protected:
  static sim::SimulationOptions street(const std::string& sensor, double height, int scans) {
    sim::SimulationOptions options;
    options.sensor = sensor;
    options.height = height;
    options.world.seed = 911;
    options.world.length = 120;
    options.world.treeShare = 0.1;
    options.spacing = 1;
    options.scans = scans;
    return options;
  }

  nlohmann::json run(const std::string& batch, const std::vector<std::string>& set) {
    return runFile(fs::path(POLEMCL_SOURCE_DIR) / "config/batches" / (batch + ".ini"), set);
  }
  nlohmann::json runFile(const fs::path& batch, const std::vector<std::string>& set) {
    BatchOptions options;
    options.batch = batch;
    options.data = data.path();
    options.output = output / batch.stem().string();
    options.set = set;
    options.quiet = true;
    try {
      doBatch(options);
    } catch (const Error& error) {
      ADD_FAILURE() << error.what();
    }
    report = readText(options.output / "report.html");
    return resultsIn(options.output);
  }

  /// Ours knows where it is, the paper's method has figures: a short street proves no more.
  static void expectLocalized(const nlohmann::json& batch, double bound) {
    EXPECT_TRUE(batch["failures"].empty());
    std::size_t runs = 0;
    for (const auto& result : batch["results"])
      for (const auto& run : result["runs"]) {
        ++runs;
        const std::string configuration = result["setting"];
        EXPECT_EQ(run["failure"], "") << configuration;
        EXPECT_GT(run["errors"]["poses"], 20) << configuration;
        EXPECT_GT(run["errors"]["pos_mean"], 0) << configuration;
        EXPECT_LT(run["errors"]["pos_mean"], configuration.rfind("ours", 0) == 0 ? bound : 3.0)
            << configuration;
      }
    EXPECT_GE(runs, batch["settings"].size());
  }

  static void expectScored(const nlohmann::json& batch, double bound) {
    EXPECT_TRUE(batch["failures"].empty());
    std::size_t scores = 0;
    for (const auto& result : batch["results"]) {
      const auto& score = result["map_score"];
      if (score.is_null()) continue;
      ++scores;
      const std::string configuration = result["setting"];
      const auto &near = score["near_1m"], &oneToOne = score["one_to_one_1m"],
                 &half = score["one_to_one_0.5m"];
      EXPECT_GE(near["matches"], oneToOne["matches"]) << configuration;
      EXPECT_GE(oneToOne["matches"], half["matches"]) << configuration;
      EXPECT_GT(near["map_poles"], 0) << configuration;
      if (configuration == "ours") {
        EXPECT_GT(half["f1"], bound);
      }
    }
    EXPECT_GE(scores, batch["settings"].size());
  }

  /// The rows of the page's tables, in that order.
  void expectRows(const std::vector<std::string>& rows) const {
    std::size_t at = 0;
    for (const auto& row : rows) {
      const auto found = report.find("<th scope=\"row\">" + row + "</th>", at);
      EXPECT_NE(found, std::string::npos) << row;
      if (found != std::string::npos) at = found;
    }
  }

  TempFolder data, output;
  std::string report;
};

TEST_F(PaperBatches, TableOneOfNclt) {
  auto options = street("hdl32e", 0.86, 60);
  options.upsideDown = true;
  options.originZ = 0.957;
  writeNclt(options, data / "2012-01-08", 1326030000000000, data / "nclt_truth.npz");
  options.world.day = 1;
  writeNclt(options, data / "2012-01-15", 1326652795000000, output / "other_day.npz");
  const auto results = run("table1-nclt", {"sessions.names=2012-01-08 2012-01-15"});
  expectScored(results, 0.5);
  ASSERT_EQ(results["settings"].size(), 2u);
  EXPECT_TRUE(resultOf(results, "paper-mode", "2012-01-08")["map_score"]
                  .is_null());  // one map of both sessions
  EXPECT_EQ(resultOf(results, "ours", "2012-01-15")["map_score"]["truth"], "nclt_truth.npz");
  expectRows({"Schaefer et al. 2019", "Dong et al. 2021", "polemcl, paper-mode", "polemcl, ours"});
  const auto maps = io::readLines(output / "table1-nclt/maps.csv");
  ASSERT_EQ(maps.size(), 3u);
  EXPECT_EQ(maps[2].rfind("ours,2012-01-15,nclt_truth.npz,", 0), 0u) << maps[2];

  // Table III on the same two sessions, scored as well.
  const auto three = run("nclt", {"sessions.names=2012-01-08 2012-01-15", "batch.runs=1",
                                  "sessions.truth_map={data}/nclt_truth.npz"});
  expectLocalized(three, 0.15);
  ASSERT_EQ(three["settings"].size(), 3u);
  EXPECT_EQ(three["published_sessions"].size(), 54u);
  EXPECT_TRUE(resultOf(three, "ours-strict", "2012-01-15")["map_score"].is_object());
  expectRows({"Schaefer et al. 2019", "Dong et al. 2021", "polemcl, paper-mode", "polemcl, ours",
              "polemcl, ours-strict"});
  // The paper's 0.115 m and 20.4 cm of these sessions, in the unit of the column.
  EXPECT_NE(report.find("<td>11.5</td>"), std::string::npos);
  EXPECT_NE(report.find("<td>20.4</td>"), std::string::npos);
  // What the rows are means of, not what the whole batch would be.
  EXPECT_NE(report.find("2 sessions, runs: 2. One map of 2 sessions"), std::string::npos);
  const std::string latex = readText(output / "nclt/table.tex");
  EXPECT_NE(latex.find("\\emph{ours-strict}: 1 session, runs: 1. Each session"), std::string::npos);
  EXPECT_EQ(latex.find("27 sessions"), latex.rfind("27 sessions"));  // the published ones

  // The variation on the page about batches, in a folder without any other file.
  const std::string page = readText(fs::path(POLEMCL_SOURCE_DIR) / "share/doc/batch.md");
  const auto at = page.find("```ini\n", page.find("## NCLT with a variation of mine")) + 7;
  writeText(output / "own/mine.ini", page.substr(at, page.find("```", at) - at));
  const auto mine = runFile(output / "own/mine.ini", {"batch.settings=mine", "batch.runs=1",
                                                      "sessions.names=2012-01-08 2012-01-15"});
  expectLocalized(mine, 0.15);
  ASSERT_EQ(mine["settings"].size(), 1u);
  expectRows({"Schaefer et al. 2019", "Dong et al. 2021", "polemcl, mine"});
}

TEST_F(PaperBatches, TableOneOfSemanticKitti) {
  auto options = street("hdl64e_kitti", 1.73, 40);
  writeSemanticKitti(options, data / "sequences/00");
  options.world.seed = 912;
  writeSemanticKitti(options, data / "sequences/01");
  const auto results = run("table1-semantickitti", {"sessions.names=00 01"});
  expectScored(results, 0.5);
  ASSERT_EQ(results["settings"].size(), 3u);
  ASSERT_EQ(results["results"].size(), 6u);
  for (const auto& result : results["results"]) EXPECT_EQ(result["map_score"]["truth"], "labels");
  expectRows({"Schaefer et al. 2019", "Dong et al. 2021", "polemcl, paper-mode-mended",
              "polemcl, paper-mode", "polemcl, ours"});
}

TEST_F(PaperBatches, TableTwoMulran) {
  auto options = street("os1_64", 1.80, 60);
  writeMulran(options, data / "KAIST02", 1566535940000000000);
  options.world.day = 1;
  options.driveSeed = 1;
  writeMulran(options, data / "KAIST01", 1561000444000000000);
  const auto results = run("mulran", {"batch.runs=1"});
  expectLocalized(results, 0.15);
  expectRows({"Schaefer et al. 2019", "Chen et al. 2021", "Dong et al. 2021", "polemcl, paper-mode",
              "polemcl, ours"});
}

TEST_F(PaperBatches, TableFourKitti) {
  writeKittiRaw(street("hdl64e_kitti", 1.73, 60), data / "2011_09_26/2011_09_26_drive_0009_sync");
  const auto results = run("kitti", {"batch.runs=1"});
  expectLocalized(results, 0.15);
  ASSERT_EQ(results["settings"].size(), 4u);
  expectRows({"Kümmerle et al. 2019", "Weng et al. 2018", "Sefati et al. 2017",
              "Schaefer et al. 2019", "Dong et al. 2021", "polemcl, paper-mode-mended",
              "polemcl, paper-mode", "polemcl, ours", "polemcl, ours-strict"});
}

}  // namespace
}  // namespace polemcl::test_paper_batches
