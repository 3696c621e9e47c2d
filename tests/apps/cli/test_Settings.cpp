#include <polemcl/core/common/Types.h>
#include "cli/Settings.h"
#include "support/Refusal.h"
#include "support/TempFolder.h"

namespace polemcl::test_settings {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

std::vector<fs::path> configurations() {
  const std::vector<std::string> others{"batches", "live", "mrpt"};  // hold no settings of ours
  std::vector<fs::path> files;
  for (const auto& entry :
       fs::recursive_directory_iterator(fs::path(POLEMCL_SOURCE_DIR) / "config"))
    if (entry.path().extension() == ".ini" &&
        std::find(others.begin(), others.end(), entry.path().parent_path().filename()) ==
            others.end())
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

fs::path config(const std::string& name) {
  return fs::path(POLEMCL_SOURCE_DIR) / "config" / name;
}

std::string errorOf(const std::string& ini) {
  const TempFolder folder;
  writeText(folder / "a.ini", ini);
  return messageOf([&] { loadSettings((folder / "a.ini").string()); });
}

TEST(Settings, EveryConfigurationLoadsAndSurvivesSaving) {
  const auto files = configurations();
  EXPECT_GE(files.size(), 9u);
  const TempFolder folder;
  for (const auto& file : files) {
    SCOPED_TRACE(file.string());
    const auto settings = loadSettings(file.string());
    saveSettings(settings, (folder / "saved.ini").string());
    EXPECT_EQ(settingsText(loadSettings((folder / "saved.ini").string())), settingsText(settings));
  }
}

TEST(Settings, EveryValueInTheConfigurationsIsExplained) {
  for (const auto& file : configurations()) {
    std::istringstream lines(readText(file));
    std::string line;
    while (std::getline(lines, line)) {
      if (line.find(" = ") != std::string::npos && line[0] != ';') {
        EXPECT_NE(line.find("  ; "), std::string::npos) << file << ": " << line;
      }
    }
  }
}

TEST(Settings, ConfigurationsSayWhatTheyAreFor) {
  const auto kitti = loadSettings(config("kitti.ini").string());
  EXPECT_EQ(kitti.sensor.model, "hdl64e");
  EXPECT_EQ(kitti.sensor.height, 1.73);
  EXPECT_EQ(kitti.extraction.method, ExtractionMethod::scanLine);
  const auto nclt = loadSettings(config("nclt.ini").string());
  EXPECT_TRUE(nclt.sensor.upsideDown);
  EXPECT_EQ(nclt.sensor.originZ, 0.957);
  const auto paper = loadSettings(config("paper/nclt.ini").string());
  EXPECT_EQ(paper.extraction.method, ExtractionMethod::rangeImage);
  EXPECT_EQ(paper.extraction.rangeImage.columns, 250);
  EXPECT_NEAR(paper.extraction.rangeImage.fovUp, 30.67 * M_PI / 180, 1e-12);
  EXPECT_EQ(paper.extraction.rangeImage.projectFrom, "cloud");
  EXPECT_EQ(paper.map.minCount, 6);
  EXPECT_EQ(paper.likelihood.model, LikelihoodModel::floored);
  EXPECT_EQ(paper.localization.filter.estimate, PoseEstimator::bestShare);
}

TEST(Settings, TheMendedPaperDiffersInOneHeight) {
  auto kitti = loadSettings(config("paper/kitti.ini").string());
  const auto mended = loadSettings(config("paper/kitti-mended.ini").string());
  EXPECT_EQ(kitti.extraction.rangeImage.minTop, 0.7);
  EXPECT_EQ(mended.extraction.rangeImage.minTop, 0);
  kitti.extraction.rangeImage.minTop = 0;
  EXPECT_EQ(settingsText(mended), settingsText(kitti));
}

TEST(Settings, KnowsEverySection) {
  const AllSettings defaults;
  std::istringstream lines(settingsText(defaults));
  std::vector<std::string> sections;
  for (std::string line; std::getline(lines, line);)
    if (!line.empty() && line[0] == '[') sections.push_back(line);
  const std::vector<std::string> expected{"[sensor]",
                                          "[extraction]",
                                          "[range_image]",
                                          "[scan_line]",
                                          "[vehicle]",
                                          "[map]",
                                          "[map_update]",
                                          "[likelihood]",
                                          "[motion]",
                                          "[filter]",
                                          "[start]",
                                          "[tracking]",
                                          "[health]",
                                          "[search]",
                                          "[odometry_monitor]",
                                          "[odometry_calibration]",
                                          "[runs]",
                                          "[view]",
                                          "[simulation]",
                                          "[world]",
                                          "[realism]"};
  EXPECT_TRUE(
      std::is_permutation(sections.begin(), sections.end(), expected.begin(), expected.end()))
      << testing::PrintToString(sections);
  for (const std::string& section : expected) {  // each is read: a key it does not know is refused
    EXPECT_HAS(errorOf(section + "\nno_such_key = 1\n"), "no_such_key") << section;
  }
}

TEST(Settings, TheSimulatedSensorIsTheConfiguredOne) {
  const auto settings = loadSettings(config("nclt.ini").string());
  EXPECT_EQ(settings.simulation.sensor, "hdl32e");
  EXPECT_EQ(settings.simulation.height, settings.sensor.height);
  EXPECT_TRUE(settings.simulation.upsideDown);
  // The extraction's hdl64e has the angles of KITTI's unit, so has the one that is simulated.
  EXPECT_EQ(loadSettings(config("kitti.ini").string()).simulation.sensor, "hdl64e_kitti");
}

TEST(Settings, RefusalsNameFileSectionAndKey) {
  const std::pair<std::string, std::vector<std::string>> refusals[] = {
      {"[senser]\nmodel = hdl64e\n", {"a.ini", "senser"}},
      {"[sensor]\nheigth_m = 1\n", {"a.ini", "sensor", "heigth_m"}},
      {"[filter]\nparticles = many\n", {"a.ini", "filter", "particles", "many"}},
      {"[filter]\nparticles = 0\n", {"a.ini", "filter", "particles", "0"}},
  };
  for (const auto& [ini, words] : refusals)
    for (const std::string& word : words) EXPECT_HAS(errorOf(ini), word);
  EXPECT_HAS(messageOf([] { loadSettings("no/such/file.ini"); }), "no/such/file.ini");
}

}  // namespace
}  // namespace polemcl::test_settings
