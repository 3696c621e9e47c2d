#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "core/extraction/PoleClassifier.h"
#include "sim/common/Random.h"

namespace polemcl::test_pole_classifier {
namespace {

struct Row {
  double mean, scale, full, rough;
};

/// The table that the library is built with, read by other means.
struct Table {
  std::map<std::string, Row> terms;
  std::map<std::string, double> products;  ///< by "a*b"
  Table() {
    std::ifstream file(std::string(POLEMCL_SOURCE_DIR) +
                       "/libpolemcl/src/core/extraction/classifier.csv");
    for (std::string line; std::getline(file, line);) {
      std::replace(line.begin(), line.end(), ',', ' ');
      std::istringstream fields(line);
      std::string name;
      Row row{};
      if (!(fields >> name) || name[0] == '#' || !(fields >> row.mean)) continue;
      if (fields >> row.scale >> row.full >> row.rough)
        terms[name] = row;
      else
        products[name] = row.mean;
    }
  }
};

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

}  // namespace

TEST(PoleClassifier, OddsAreTheWeightedSumOfTheTable) {
  const Table table;
  ASSERT_EQ(table.terms.size(), static_cast<std::size_t>(kClassifierTerms));
  sim::Random random(3);
  for (int i = 0; i < 500; ++i) {
    const PoleFeatures features = randomFeatures(random);
    std::map<std::string, double> terms = termsOf(features);
    double full = 0, rough = 0;
    for (auto& [name, value] : terms) {
      const Row& row = table.terms.at(name);
      if (name != "one") value = std::clamp((value - row.mean) * row.scale, -3.0, 3.0);
      full += row.full * value;
      rough += row.rough * value;
    }
    for (const auto& [name, weight] : table.products) {
      const auto star = name.find('*');
      full += weight * terms.at(name.substr(0, star)) * terms.at(name.substr(star + 1));
    }
    ASSERT_NEAR(poleOdds(features), full, 1e-9);
    ASSERT_NEAR(roughOdds(features), rough, 1e-9);
  }
}

}  // namespace polemcl::test_pole_classifier
