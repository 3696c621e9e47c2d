#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/extraction/PoleClassifier.h"
#include "sim/common/Random.h"

namespace polemcl::test_pole_classifier {
namespace {
struct Row {
  std::string term;
  std::vector<double> values;
};

/// The rows of a table that the library is built with, read by other means.
std::vector<Row> readTable(const char* name) {
  std::ifstream file(std::string(POLEMCL_SOURCE_DIR) + "/libpolemcl/src/core/extraction/" + name);
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    Row row;
    fields >> row.term;
    for (double value; fields >> value;) row.values.push_back(value);
    if (!row.values.empty() && row.term[0] != '#') rows.push_back(row);
  }
  return rows;
}

/// The value of the tree whose root is at `rows[i]`; `end` becomes the row after it.
double valueOf(const std::vector<Row>& rows, std::size_t i,
               const std::map<std::string, double>& terms, std::size_t& end) {
  const double value = rows[i].values[0], step = rows[i].values[1];
  if (step < 0) {
    end = i + static_cast<std::size_t>(-step);
    return value;
  }
  const bool near = terms.at(rows[i].term) <= value;
  return valueOf(rows, i + (near ? 1 : static_cast<std::size_t>(step)), terms, end);
}

/// The terms by their meaning.
std::map<std::string, double> termsOf(const PoleFeatures& f) {
  const double expected = std::max(1.0, 2 * f.radius / f.columnWidth);  // returns of a segment
  return {{"one", 1},
          {"logSegments", std::log(f.segments)},
          {"logPoints", std::log(f.points)},
          {"extent", std::min(f.extent, 3.0)},
          {"passed", f.passed},
          {"wide", f.wide},
          {"notWhole", f.notWhole},
          {"scatter", f.scatter},
          {"widthSpread", f.widthSpread},
          {"lowTop", f.missingTop},
          {"roughRadius", f.roughRadius},
          {"top", std::min(f.top, 6.0)},
          {"bottom", f.bottom},
          {"clutter", f.clutter},
          {"excess", f.residual > 0.02 ? f.residual - 0.02 : 0},
          {"highBottom", f.bottom > 1 ? f.bottom - 1 : 0},
          {"tilt", f.tilt},
          {"range", f.range / 40},
          {"radius", f.radius},
          {"density", std::log(f.points / f.segments / expected)}};
}

double sumOf(const std::vector<Row>& rows, const PoleFeatures& features) {
  const auto terms = termsOf(features);
  double odds = 0;
  for (std::size_t at = 0; at < rows.size();) odds += valueOf(rows, at, terms, at);
  return odds;
}

PoleFeatures randomFeatures(sim::Random& random) {
  PoleFeatures f;
  f.segments = std::floor(random.uniform(1, 30));
  f.points = f.segments * random.uniform(1, 9);
  for (double* share : {&f.passed, &f.wide, &f.notWhole, &f.clutter}) *share = random.uniform();
  for (double* metres : {&f.scatter, &f.widthSpread, &f.residual, &f.roughRadius, &f.radius})
    *metres = random.uniform(0.005, 0.4);
  f.extent = random.uniform(0, 5);
  f.tilt = random.uniform(0, 0.4);
  f.top = random.uniform(0, 9);
  f.missingTop = random.uniform(0, 2);
  f.bottom = random.uniform(-0.5, 3);
  f.range = random.uniform(2, 60);
  f.columnWidth = random.uniform(0.005, 0.2);
  return f;
}

TEST(PoleClassifier, OddsAreTheSumOfTheTrees) {
  const std::vector<Row> trees = readTable("trees.csv"), rough = readTable("rough_trees.csv");
  sim::Random random(3);
  for (int i = 0; i < 500; ++i) {
    const PoleFeatures features = randomFeatures(random);
    ASSERT_NEAR(poleOdds(features), sumOf(trees, features), 1e-5);
    ASSERT_NEAR(roughOdds(features), sumOf(rough, features), 1e-5);
  }
}

// The extractor leaves out candidates that clutter could only make less likely.
TEST(PoleClassifier, OddsNeverGrowWithClutter) {
  sim::Random random(5);
  double fall = 0;
  for (int i = 0; i < 500; ++i) {
    PoleFeatures features = randomFeatures(random);
    double before = 1e9;
    for (const double clutter : {0.0, 0.1, 0.3, 0.6, 1.0}) {
      features.clutter = clutter;
      const double odds = poleOdds(features);
      ASSERT_LE(odds, before);
      if (clutter > 0) fall += before - odds;
      before = odds;
    }
  }
  EXPECT_GT(fall, 100);
}

}  // namespace
}  // namespace polemcl::test_pole_classifier
