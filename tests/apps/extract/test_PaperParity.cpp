// Paper mode finds the poles that the paper's authors' program finds in the same scans.

#include <cmath>
#include <cstdlib>
#include <map>

#include "core/evaluation/MapEvaluation.h"
#include "extract/ExtractApp.h"
#include "import/ImportApp.h"
#include "io/file/CsvTable.h"
#include "support/TempFolder.h"

namespace polemcl::test_paper_parity {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

struct Pole {
  double x, y, radius;
};
using Scans = std::map<int, std::vector<Pole>>;

/// \param sideOfY -1 where y counts to the right in the file.
Scans readPoles(const fs::path& file, double sideOfY) {
  const io::CsvTable table(file);
  const auto column = [&](const char* name) { return table.column(name); };
  Scans scans;
  for (std::size_t i = 0; i < table.rows(); ++i)
    scans[static_cast<int>(table.number(i, column("scan")))].push_back(
        {table.number(i, column("x")), sideOfY * table.number(i, column("y")),
         table.number(i, column("radius"))});
  return scans;
}

std::size_t count(const Scans& scans) {
  std::size_t sum = 0;
  for (const auto& [scan, poles] : scans) sum += poles.size();
  return sum;
}

/// Poles with a partner, one to one, within `reach` and half of it in the radius, m.
std::size_t partners(const Scans& theirs, Scans ours, double reach) {
  std::size_t sum = 0;
  for (const auto& [scan, poles] : theirs) {
    std::vector<std::vector<std::uint32_t>> edges;
    const auto& others = ours[scan];
    for (const Pole& pole : poles) {
      auto& near = edges.emplace_back();
      for (std::uint32_t i = 0; i < others.size(); ++i)
        if (std::hypot(others[i].x - pole.x, others[i].y - pole.y) <= reach &&
            std::abs(others[i].radius - pole.radius) <= reach / 2)
          near.push_back(i);
    }
    sum += maximumMatching(edges, others.size());
  }
  return sum;
}

struct DataSet {
  const char* name;
  const char* importer;
  const char* config;
  std::size_t poles;
};
void PrintTo(const DataSet& set, std::ostream* out) {
  *out << set.name;
}

class PaperParity : public testing::TestWithParam<DataSet> {
 protected:
  fs::path data() const { return std::getenv("POLEMCL_DATA"); }
  std::string at(const char* name) const { return (folder / name).string(); }
  Outcome import() {
    return runProgram(importMain,
                      {GetParam().importer, "--input", (data() / GetParam().name).string(),
                       "--output", at("scans.rawlog")});
  }
  Outcome extract(const std::string& config) {
    return runProgram(extractMain, {"--config", std::string(POLEMCL_SOURCE_DIR) + config, "--input",
                                    at("scans.rawlog"), "--output", at("poles.rawlog"), "--csv",
                                    at("poles.csv")});
  }
  TempFolder folder;
};

// The issue asks for 97 % within 2 cm and 1 cm, and at most 3 % more. All are within the rounding
// of their table, 0.1 mm; 1 % is left for other versions of the mathematical functions.
TEST_P(PaperParity, FindsThePolesOfTheAuthorsProgram) {
  if (!std::getenv("POLEMCL_DATA")) GTEST_SKIP() << "POLEMCL_DATA is not set";
  const Outcome imported = succeeded(import());
  const Outcome extracted = succeeded(extract(GetParam().config));
  // NCLT's files are in the body frame, y to the right.
  const double side = std::string(GetParam().importer) == "nclt" ? -1 : 1;
  const Scans ours = readPoles(folder / "poles.csv", 1);
  const Scans theirs =
      readPoles(data() / "first_implementation" / (std::string(GetParam().name) + ".csv"), side);
  ASSERT_EQ(count(theirs), GetParam().poles);
  const double all = static_cast<double>(count(theirs));
  const auto found = static_cast<double>(partners(theirs, ours, 0.02));
  EXPECT_GE(found, 0.99 * all);
  EXPECT_LE(static_cast<double>(count(ours)) - found, 0.01 * all);
  EXPECT_GE(static_cast<double>(partners(theirs, ours, 0.0002)), 0.99 * all);
}

INSTANTIATE_TEST_SUITE_P(
    Real, PaperParity,
    testing::Values(DataSet{"kitti_raw_0005", "folder", "/config/paper/kitti.ini", 905},
                    DataSet{"kitti_odom_00", "folder", "/config/paper/kitti.ini", 130},
                    DataSet{"nclt_scan", "nclt", "/config/paper/nclt.ini", 4}),
    [](const auto& i) { return std::string(i.param.name); });

}  // namespace
}  // namespace polemcl::test_paper_parity
