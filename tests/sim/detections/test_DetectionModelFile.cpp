#include <gtest/gtest.h>

#include <fstream>

#include <polemcl/core/common/Types.h>
#include "sim/detections/DetectionModel.h"
#include "support/DetectionModels.h"
#include "support/Refusal.h"
#include "support/TempFolder.h"

namespace polemcl::test_detection_model_file {

using namespace polemcl::sim;
namespace fs = std::filesystem;

namespace {
const fs::path kModels = fs::path(POLEMCL_SOURCE_DIR) / "share" / "models";

class DetectionModelFile : public testing::Test {
 protected:
  /// The error message for the plain model's file with one text replaced.
  std::string refusal(const std::string& text, const std::string& by) {
    writeDetectionModel(file, testing_sim::plainModel());
    std::string content = testing_apps::readText(file);
    const auto at = content.find(text);
    EXPECT_NE(at, std::string::npos) << text;
    std::ofstream(file) << content.replace(at, text.size(), by);
    return tests::messageOf([&] { readDetectionModel(file); });
  }
  testing_apps::TempFolder m_folder;
  fs::path file = m_folder / "model.json";
};
}  // namespace

TEST_F(DetectionModelFile, ReadsBackWhatWasWritten) {
  DetectionModel model = testing_sim::plainModel();
  model.fittedOn = "by hand";
  model.points = 64283;
  model.poleVisibility.today = {0.1, 0.2, 0, 0, 0.3};
  model.noise[3].always = {0, 0, 0.25, 0, 0};
  model.clutterAlways = 0.0625;
  model.season = {{0, -0.1, -0.2, -0.3}, {0.1, 0.2, 0.3, 0.4}, -1.5, 0.25};
  writeDetectionModel(file, model);
  const DetectionModel read = readDetectionModel(file);
  EXPECT_EQ(read.fittedOn, "by hand");
  EXPECT_EQ(read.points, 64283u);
  EXPECT_EQ(read.poleVisibility.today, model.poleVisibility.today);
  EXPECT_EQ(read.noise[3].always, model.noise[3].always);
  EXPECT_EQ(read.clutterAlways, 0.0625);
  EXPECT_EQ(read.season.snow, model.season.snow);
  EXPECT_EQ(read.season.bare, model.season.bare);
  EXPECT_EQ(read.season.fence, -1.5);
  EXPECT_EQ(read.season.siteClutter, 0.25);
  EXPECT_EQ(read.of(DetectionClass::tree).reported[7], model.of(DetectionClass::tree).reported[7]);
  const std::string first = testing_apps::readText(file);
  writeDetectionModel(file, read);
  EXPECT_EQ(testing_apps::readText(file), first);
}

TEST_F(DetectionModelFile, WithoutSeasonsTheyChangeNothing) {
  DetectionModel model = testing_sim::plainModel();
  model.season.fence = -1;
  writeDetectionModel(file, model);
  std::string text = testing_apps::readText(file);
  const auto from = text.find("  \"season\": {"), to = text.find("  \"persistence\"");
  ASSERT_LT(from, to);
  std::ofstream(file) << text.erase(from, to - from);
  const SeasonModel read = readDetectionModel(file).season;
  EXPECT_EQ(read.fence, 0);
  EXPECT_EQ(read.siteClutter, 0);
  EXPECT_EQ(read.bare, SeasonModel().bare);
}

TEST_F(DetectionModelFile, ShippedModelsCanBeRead) {
  std::size_t models = 0;
  for (const auto& entry : fs::directory_iterator(kModels)) {
    EXPECT_NO_THROW(readDetectionModel(entry.path())) << entry.path();
    ++models;
  }
  EXPECT_GT(models, 0u);
}

TEST_F(DetectionModelFile, NamesFileKeyAndWhatIsAllowed) {
  const auto expect = [&](const std::string& text, const std::string& by, const std::string& word) {
    const std::string said = refusal(text, by);
    EXPECT_HAS(said, "model.json: ");
    EXPECT_HAS(said, word);
  };
  expect("detection model 1", "detection model 9", "format: only");
  expect("\"height_m\": 1.0", "\"height_m\": \"high\"", "height_m: a number");
  expect("\"height_m\": 1.0", "\"height_m\": -1", "height_m: -1 is not allowed; 0.1 to 10");
  expect("\"height_m\": 1.0", "\"hight_m\": 1.0", "height_m: is missing");
  expect("\"behind_houses\"", "\"in_front\": 0, \"behind_houses\"", "in_front: is not known");
  expect("\"detected\": [0.6,", "\"detected\": [1.6,", "classes.lamp_post.detected: 1.6");
  expect("\"detected\": [0.6,0.6]", "\"detected\": [0.6]", "classes.lamp_post.detected: one");
  expect("[0.7,0.7,", "[1.7,0.7,", "confidence: the values must ascend");
  expect("[5.0,35.0]", "[35.0,5.0]", "detected_range_m: the values must ascend");
  expect("\"always\": [0.0,0.0", "\"always\": [0.8,0.8", "persistence.poles: the shares");
  expect("\"fence\": 0.0", "\"fence\": 9", "season.fence: 9 is not allowed");
  expect("\"always\": [0.0,", "\"always\": [", "5 numbers are needed, 4");
  expect("0.002,", "0.003,", "levels: not the quantiles");
  expect("{", "", "not JSON");
}

}  // namespace polemcl::test_detection_model_file
