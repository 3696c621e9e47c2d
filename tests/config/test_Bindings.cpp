#include <gtest/gtest.h>

#include <map>

#include "config/Bindings.h"
#include "io/file/TextFile.h"
#include "mrpt/rawlog/MotionOptions.h"

namespace polemcl::test_bindings {
namespace {

struct All {
  SensorOptions sensor;
  ExtractionOptions extraction;
  PoleMapOptions map;
  LikelihoodOptions likelihood;
  MotionOptions motion;
};

void bindAll(Binder& binder, All& all) {
  bind(binder, all.sensor);
  bind(binder, all.extraction);
  bind(binder, all.map);
  bind(binder, all.likelihood);
  bind(binder, all.motion);
}

std::string written(All all) {
  ConfigWriter writer;
  bindAll(writer, all);
  return writer.text();
}

All load(const std::string& text) {
  ConfigReader reader(ConfigFile::fromText(text, "t.ini"));
  All all;
  bindAll(reader, all);
  reader.finish();
  return all;
}

/// Names of keys with their values, in the order of the file.
std::vector<std::pair<std::string, std::string>> keys(const std::string& text) {
  std::vector<std::pair<std::string, std::string>> result;
  std::string section;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    if (line.empty() || line[0] == '#') continue;
    if (line[0] == '[') {
      section = line;
      continue;
    }
    const auto equals = line.find(" = ");
    const std::string value = line.substr(equals + 3, line.find("  //") - equals - 3);
    result.emplace_back(section + line.substr(0, equals), io::trimmed(value));
  }
  return result;
}

TEST(Bindings, DefaultsSurvive) {
  const std::string text = written(All());
  EXPECT_EQ(written(load(text)), text);
}

// Changes the value of one key after the other in the file. After reading and writing again, only
// that key has changed. Hence every key is bound to its own field.
TEST(Bindings, EveryKeyHasAFieldOfItsOwn) {
  const std::string base = written(All());
  const auto before = keys(base);
  ASSERT_GT(before.size(), 60u);
  const std::map<std::string, std::string> otherChoices = {
      {"circle_fit", "taubin"},        {"free_space", "ring"}, {"project_from", "cloud"},
      {"foreground_test", "in_front"}, {"middle", "passed"},   {"merging", "boxes"},
      {"counting", "members"}};
  for (const auto& [name, value] : before) {
    SCOPED_TRACE(name + " = " + value);
    const std::string key = name.substr(name.find(']') + 1);
    const std::string section = name.substr(0, name.find(']') + 1);
    std::string other;
    if (value == "true")
      other = "false";
    else if (value == "false")
      other = "true";
    else if (key == "model" && section == "[sensor]")
      other = "os1_64";
    else if (key == "model")
      other = "paper";
    else if (key == "method")
      other = "range_image";
    else if (const auto choice = otherChoices.find(key); choice != otherChoices.end())
      other = choice->second;
    else if (key == "elevations_deg" || key == "lower_elevations_deg" || key == "apex_m")
      other = "1 2";
    else if (key == "origin")
      other = "1 2 3";
    else if (key == "edge_step_m")
      other = "0.5";
    else if (key == "columns")
      other = "1024";
    else if (value.find('.') == std::string::npos)
      other = std::to_string(std::stoi(value) + 1);
    else if (value[0] == '-')
      other = "-1.125";
    else
      other = std::to_string(std::stod(value) * 0.875);
    const All changed = load(section + "\n" + key + " = " + other + "\n");
    const auto after = keys(written(changed));
    ASSERT_EQ(after.size(), before.size());
    std::size_t differences = 0;
    for (std::size_t i = 0; i < after.size(); ++i)
      if (after[i].second != before[i].second) {
        ++differences;
        EXPECT_EQ(after[i].first, name);
      }
    EXPECT_EQ(differences, 1u) << name << " = " << other;
  }
}

TEST(Bindings, ReadsHandPickedValues) {
  const All all = load(
      "[sensor]\nmodel = table\nelevations_deg = 10 0 -10\ncolumns = 900\nheight_m = 1.2\n"
      "origin = 0 0 0.957\nupside_down = true\n"
      "[extraction]\nmethod = range_image\n"
      "[range_image]\nepsilon_m = 0.08\nmax_bottom_m = 1.4\n"
      "[scan_line]\nmin_top_m = 2.5\nmax_tilt_deg = 10\n"
      "[map]\nsection_length_m = 0.25\nmin_count = 6\n"
      "[likelihood]\nmodel = paper\nsigma_m = 1.2247\n"
      "[motion]\ncovariance_factor = 4\nmin_yaw_deg = 0.1\n");
  ASSERT_EQ(all.sensor.elevations.size(), 3u);
  EXPECT_NEAR(all.sensor.elevations[2], -0.17453293, 1e-8);
  EXPECT_EQ(all.sensor.originZ, 0.957);
  EXPECT_TRUE(all.sensor.upsideDown);
  EXPECT_EQ(all.extraction.method, ExtractionMethod::rangeImage);
  EXPECT_EQ(all.extraction.rangeImage.epsilon, 0.08);
  EXPECT_EQ(all.extraction.rangeImage.maxBottom, 1.4);
  EXPECT_EQ(all.extraction.scanLine.minTop, 2.5);
  EXPECT_NEAR(all.extraction.scanLine.maxTilt, 0.17453293, 1e-8);
  EXPECT_EQ(all.map.sectionLength, 0.25);
  EXPECT_EQ(all.map.minCount, 6);
  EXPECT_EQ(all.likelihood.model, LikelihoodModel::paper);
  EXPECT_EQ(all.likelihood.sigma, 1.2247);
  EXPECT_EQ(all.motion.covarianceFactor, 4);
  EXPECT_NEAR(all.motion.minYaw, 0.0017453293, 1e-9);
}

// The struct itself rejects contradictions that ranges cannot express; the message names the file.
TEST(Bindings, RefusesStructsThatContradictThemselves) {
  for (const char* text :
       {"[sensor]\nmodel = table\n", "[sensor]\nmin_range_m = 70\n",
        "[range_image]\nfov_up_deg = -80\n", "[scan_line]\nmin_radius_m = 0.5\n"}) {
    try {
      load(text);
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find("t.ini: ["), 0u) << error.what();
    }
  }
}

TEST(Bindings, RefusesRanges) {
  for (const char* text :
       {"[likelihood]\noutlier = 0\n", "[likelihood]\noutlier = 1\n", "[likelihood]\nsigma_m = 0\n",
        "[likelihood]\nmodel = floored\nweighted = true\n",
        "[map]\nevery_scan = true\nmiddle = passed\n", "[map]\nmin_count = 0\n",
        "[map]\nsection_length_m = 0\n", "[range_image]\nrows = 1\n", "[motion]\nxy_per_m = -0.1\n",
        "[scan_line]\nmin_confidence = 1.1\n"})
    EXPECT_THROW(load(text), Error) << text;
}

}  // namespace
}  // namespace polemcl::test_bindings
