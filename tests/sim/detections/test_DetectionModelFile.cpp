#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <polemcl/core/common/Types.h>
#include "sim/detections/DetectionModel.h"
#include "support/Refusal.h"
#include "support/TempFolder.h"

namespace polemcl::test_detection_model_file {
namespace {

using namespace polemcl::sim;
namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;
const fs::path kModels = fs::path(POLEMCL_SOURCE_DIR) / "share" / "models";

class DetectionModelFile : public testing::Test {
 protected:
  DetectionModel read() const {
    testing_apps::writeText(file, json.dump());
    return readDetectionModel(file);
  }
  /// The error message for the shipped file with one value replaced.
  std::string refusal(const std::string& pointer, const Json& value) {
    const Json whole = json;
    json[Json::json_pointer(pointer)] = value;
    const std::string said = tests::messageOf([&] { read(); });
    json = whole;
    return said;
  }
  testing_apps::TempFolder m_folder;
  fs::path file = m_folder / "model.json";
  Json json = Json::parse(testing_apps::readText(kModels / "hdl32e.json"));
};
TEST_F(DetectionModelFile, ReadsWhatIsWritten) {
  json["fitted_on"] = "by hand";
  json["points_per_scan"] = 64283;
  json["clutter_per_m"] = {{"always", 0.0625}, {"today", 0.5}};
  json["persistence"]["poles"]["today"] = {0.1, 0.2, 0, 0, 0.3};
  json["persistence"]["poles"]["always"] = {0, 0, 0, 0, 0.25};
  json["season"] = {{"snow", {0, -0.1, -0.2, -0.3}},
                    {"bare", {0.1, 0.2, 0.3, 0.4}},
                    {"fence", -1.5},
                    {"site_clutter_per_m", 0.25}};
  const DetectionModel model = read();
  EXPECT_EQ(model.fittedOn, "by hand");
  EXPECT_EQ(model.points, 64283u);
  EXPECT_EQ(model.clutterAlways, 0.0625);
  EXPECT_EQ(model.clutterToday, 0.5);
  EXPECT_EQ(model.poleVisibility.today, (std::array<double, 5>{0.1, 0.2, 0, 0, 0.3}));
  EXPECT_EQ(model.poleVisibility.always, (std::array<double, 5>{0, 0, 0, 0, 0.25}));
  EXPECT_EQ(model.season.snow, (std::array<double, 4>{0, -0.1, -0.2, -0.3}));
  EXPECT_EQ(model.season.bare, (std::array<double, 4>{0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(model.season.fence, -1.5);
  EXPECT_EQ(model.season.siteClutter, 0.25);
  for (int r = 0; r < kReported; ++r) {
    const std::string key = name(static_cast<Reported>(r));
    EXPECT_EQ(Json(model.noise[r].always), json["persistence"][key]["always"]) << key;
    for (int c = 0; c < kDetectionClasses; ++c)
      EXPECT_EQ(Json(model.classes[c].reported[r]),
                json["classes"][name(static_cast<DetectionClass>(c))][key])
          << key;
  }
  EXPECT_EQ(Json(model.of(DetectionClass::tree).detected), json["classes"]["tree"]["detected"]);
}

TEST_F(DetectionModelFile, WithoutSeasonsTheyChangeNothing) {
  ASSERT_EQ(json.erase("season"), 1u);
  const SeasonModel season = read().season;
  EXPECT_EQ(season.fence, 0);
  EXPECT_EQ(season.siteClutter, 0);
  EXPECT_EQ(season.bare, SeasonModel().bare);
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
  const auto expect = [&](const std::string& pointer, const Json& value, const std::string& word) {
    const std::string said = refusal(pointer, value);
    EXPECT_HAS(said, "model.json: ");
    EXPECT_HAS(said, word);
  };
  const Json few{35.0}, large(11, 1.7), many{0.8, 0.8, 0, 0, 0};
  expect("/format", "polemcl detection model 9", "format: only");
  expect("/height_m", "high", "height_m: a number");
  expect("/height_m", -1, "height_m: -1 is not allowed; 0.1 to 10");
  expect("/in_front", 0, "in_front: is not known");
  expect("/classes/lamp_post/detected/0", 1.6, "classes.lamp_post.detected: 1.6");
  expect("/classes/lamp_post/detected", few, "classes.lamp_post.detected: one");
  expect("/classes/lamp_post/confidence/0", large, "confidence: 1.7");
  expect("/classes/lamp_post/confidence/0/0", 0.999, "confidence: the values must ascend");
  expect("/detected_range_m/0", 35, "detected_range_m: the values must ascend");
  expect("/persistence/poles/always", many, "persistence.poles: the shares");
  expect("/season/fence", 9, "season.fence: 9 is not allowed");
  expect("/persistence/poles/always", few, "5 numbers are needed, 1");
  expect("/levels/0", 0.003, "levels: not the quantiles");
  json.erase("height_m");
  EXPECT_REFUSED(read(), "height_m: is missing");
  testing_apps::writeText(file, "\"format\"");
  EXPECT_REFUSED(readDetectionModel(file), "an object {...} is needed");
  testing_apps::writeText(file, "no");
  EXPECT_REFUSED(readDetectionModel(file), "not JSON");
}

}  // namespace
}  // namespace polemcl::test_detection_model_file
