#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "core/extraction/CovarianceScale.h"
#include "eval/LabelledFeatures.h"
#include "io/dataset/LabelledScans.h"
#include "io/file/CsvTable.h"
#include "sim/drive/Simulation.h"
#include "support/StreetTest.h"

namespace polemcl::test_labelled_features {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

/// Rows "name,number,…" of a table of fitted weights; the head and comments are left out.
std::map<std::string, std::vector<double>> weightsOf(const std::string& file) {
  std::map<std::string, std::vector<double>> rows;
  std::ifstream in(fs::path(POLEMCL_SOURCE_DIR) / "libpolemcl/src/core/extraction" / file);
  for (std::string line; std::getline(in, line);) {
    if (line[0] == '#' || line.rfind("term,", 0) == 0) continue;
    std::istringstream cells(line);
    std::string name, cell;
    std::getline(cells, name, ',');
    while (std::getline(cells, cell, ',')) rows[name].push_back(std::stod(cell));
  }
  return rows;
}

class LabelledFeatures : public StreetTest {
 protected:
  void SetUp() override {
    StreetTest::SetUp();
    m_settings = settings();
    m_settings.simulation.sensor = "hdl32e";
    m_settings.simulation.world.length = 80;
    m_settings.simulation.spacing = 8;
    fs::create_directories(folder / "street");
    sim::simulate(m_settings.simulation, folder / "street", {}, m_settings.sensor);
    m_options.scans = folder / "street";
    m_options.poles = folder / "street" / "poles_gt.csv";
    m_options.output = folder / "true.csv";
  }
  AllSettings m_settings;
  FeaturesOptions m_options;
};

TEST_F(LabelledFeatures, TruePolesLabelWhatIsNearThem) {
  const FeaturesSummary summary = writeFeatures(m_options, m_settings);
  EXPECT_EQ(summary.scans, 10u);
  EXPECT_GT(summary.poles, 40u);
  EXPECT_GT(summary.others, 40u);
  const io::CsvTable table(m_options.output);
  ASSERT_EQ(table.rows(), summary.poles + summary.others);
  const auto poles = io::readWorldPoles(*m_options.poles);
  std::size_t right = 0;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const double x = table.number(i, table.column("x")), y = table.number(i, table.column("y"));
    double nearest = 1e9;
    for (const WorldPole& pole : poles)
      nearest = std::min(nearest, std::hypot(pole.x - x, pole.y - y));
    const bool pole = table.count(i, table.column("pole")) == 1;
    EXPECT_TRUE(pole ? nearest < 0.31 : nearest > 0.49) << nearest;  // written to 1 mm
    EXPECT_EQ(pole, !table.text(i, table.column("squared_error")).empty());
    right += (table.number(i, table.column("odds")) > 0) == pole;
  }
  EXPECT_GT(static_cast<double>(right) / static_cast<double>(table.rows()), 0.85);
}

TEST_F(LabelledFeatures, ScaleOfTheCovarianceIsThatOfTheTableInTheSources) {
  PoleFeatures features;
  features.residual = 0.05;
  features.tilt = 0.1;
  features.range = 20;
  features.radius = 0.15;
  features.clutter = 0.5;
  features.scatter = 0.04;
  features.hiddenEdges = 0.25;
  auto weights = weightsOf("covariance.csv");
  const auto weight = [&](const char* name) { return weights.at(name).at(0); };
  const double logScale = weight("one") + 2.5 * weight("odds") + 0.03 * weight("residual") +
                          0.1 * weight("tilt") + 0.5 * weight("range") + 0.15 * weight("radius") +
                          0.5 * weight("clutter") + 0.04 * weight("scatter") +
                          0.25 * weight("hiddenEdges") + std::log(2.0) * weight("columns");
  EXPECT_NEAR(std::log(covarianceScale(features, 2.5, 0.006)), logScale, 1e-9);
}

TEST_F(LabelledFeatures, ManyScansAgreeWithTheTruthWhereTheySayAnything) {
  writeFeatures(m_options, m_settings);
  m_options.poles = std::nullopt;
  m_options.output = folder / "seen.csv";
  EXPECT_GT(writeFeatures(m_options, m_settings).poles, 10u);
  std::map<std::string, bool> truth;
  const io::CsvTable a(folder / "true.csv"), b(folder / "seen.csv");
  const auto key = [](const io::CsvTable& t, std::size_t i) {
    return t.text(i, 0) + " " + t.text(i, 1) + " " + t.text(i, 2);
  };
  for (std::size_t i = 0; i < a.rows(); ++i) truth[key(a, i)] = a.count(i, a.column("pole")) == 1;
  double polesRight = 0, poles = 0, othersRight = 0, others = 0;
  for (std::size_t i = 0; i < b.rows(); ++i) {
    const auto known = truth.find(key(b, i));
    if (known == truth.end()) continue;
    const bool pole = b.count(i, b.column("pole")) == 1;
    (pole ? poles : others) += 1;
    (pole ? polesRight : othersRight) += known->second == pole;
  }
  EXPECT_GT(polesRight / poles, 0.95) << polesRight << " of " << poles;
  EXPECT_GT(othersRight / others, 0.9) << othersRight << " of " << others;
}

TEST_F(LabelledFeatures, FeaturesNeedPosesAndTheLidarsOwnFrame) {
  AllSettings hanging = m_settings;
  hanging.sensor.upsideDown = true;
  EXPECT_THROW(writeFeatures(m_options, hanging), Error);
  fs::remove(folder / "street" / "poses.txt");
  EXPECT_THROW(writeFeatures(m_options, m_settings), Error);
}

}  // namespace
}  // namespace polemcl::test_labelled_features
