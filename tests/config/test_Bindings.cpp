#include <gtest/gtest.h>

#include <map>

#include "cli/Settings.h"
#include "config/Config.h"
#include "core/common/Angles.h"
#include "core/common/Binder.h"
#include "io/file/TextFile.h"
#include "support/Refusal.h"

namespace polemcl::test_bindings {
namespace {

using apps::AllSettings;

/// A key with its section, value and what is allowed, as the writer gives them.
struct WrittenKey {
  std::string name;  ///< section.key
  std::string value, allowed;
};

std::string written(AllSettings settings) {
  ConfigWriter writer;
  bind(writer, settings);
  return writer.text();
}

std::vector<WrittenKey> keys(const std::string& text) {
  std::vector<WrittenKey> result;
  std::string section;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    if (line.empty() || line[0] == '#') continue;
    if (line[0] == '[') {
      section = line.substr(1, line.size() - 2);
      continue;
    }
    const auto equals = line.find(" = "), comment = line.find("  //");
    std::string allowed = line.substr(line.rfind('[') + 1);
    allowed.pop_back();
    if (const auto unit = allowed.find("; "); unit != std::string::npos) allowed.erase(0, unit + 2);
    result.push_back({section + "." + line.substr(0, equals),
                      std::string(io::trimmed(line.substr(equals + 3, comment - equals - 3))),
                      allowed});
  }
  return result;
}

/// Settings from assignments `section.key=value`.
AllSettings loadWith(const std::vector<std::string>& assignments) {
  ConfigFile file = ConfigFile::fromText("", "t.ini");
  for (const auto& assignment : assignments) file.set(assignment);
  ConfigReader reader(file);
  AllSettings settings;
  bind(reader, settings);
  reader.finish();
  return settings;
}

AllSettings load(const std::string& text) {
  ConfigReader reader(ConfigFile::fromText(text, "t.ini"));
  AllSettings settings;
  bind(reader, settings);
  reader.finish();
  return settings;
}

std::string refusal(const std::string& text) {
  return tests::messageOf([&] { load(text); });
}

/// Values to try in the place of a key's, until one is allowed.
std::vector<std::string> otherValues(const WrittenKey& key) {
  if (key.value == "true") return {"false"};
  if (key.value == "false") return {"true"};
  if (key.allowed == "text") return {"2x", "some file"};
  if (key.allowed.find(" | ") != std::string::npos) {
    std::vector<std::string> words;
    for (std::size_t at = 0, end; at < key.allowed.size(); at = end + 3) {
      end = std::min(key.allowed.find(" | ", at), key.allowed.size());
      words.push_back(key.allowed.substr(at, end - at));
    }
    return words;
  }
  std::vector<std::string> values{"2 1", "1 2", "1 2 3", "2", "1", "900"};
  if (key.value.empty() || key.value.find(' ') != std::string::npos) return values;
  const double number = std::stod(key.value);
  for (const double value :
       {number * 0.875, number * 1.125, number + 1, number - 1, 0.5, 0.01, 0.95})
    values.insert(values.begin(), std::to_string(value));
  values.insert(values.begin(), std::to_string(std::lround(number) + 1));
  return values;
}

/// Where the defaults leave no other value to a key.
const std::vector<std::string> kBase{"map.every_scan=false", "tracking.average=false",
                                     "start.position_m=1 2", "world.side_streets=2",
                                     "likelihood.weighted=false"};

TEST(Bindings, DefaultsSurvive) {
  const std::string text = written(AllSettings());
  EXPECT_EQ(written(load(text)), text);
}

// One key after the other gets another value; after reading and writing again, that key and no
// other has changed. So each key is bound to a field of its own.
TEST(Bindings, EachKeyOfEachSectionHasAFieldOfItsOwn) {
  const auto before = keys(written(loadWith(kBase)));
  ASSERT_GT(before.size(), 120u);
  for (const WrittenKey& key : before) {
    if (key.name == "vehicle.lidars") continue;  // other labels have other sections
    SCOPED_TRACE(key.name + " = " + key.value);
    bool tried = false;
    for (const std::string& value : otherValues(key)) {
      std::vector<std::string> assignments = kBase;
      assignments.push_back(key.name + "=" + value);
      std::vector<WrittenKey> after;
      try {
        after = keys(written(loadWith(assignments)));
      } catch (const Error&) {
        continue;  // not allowed; the next one may be
      }
      ASSERT_EQ(after.size(), before.size());
      std::size_t differences = 0;
      for (std::size_t i = 0; i < after.size(); ++i)
        if (after[i].value != before[i].value) {
          ++differences;
          EXPECT_EQ(after[i].name, key.name) << value;
        }
      if (differences == 0) continue;  // the same value in other words
      EXPECT_EQ(differences, 1u) << value;
      tried = true;
      break;
    }
    EXPECT_TRUE(tried) << "no other value of this key has any effect";
  }
}

TEST(Bindings, ReadsHandPickedValues) {
  const AllSettings all = load(
      "[sensor]\nmodel = table\nelevations_deg = 10 0 -10\ncolumns = 900\nheight_m = 1.2\n"
      "origin = 0 0 0.957\nupside_down = true\n"
      "[extraction]\nmethod = range_image\n"
      "[range_image]\nepsilon_m = 0.08\nmax_bottom_m = 1.4\n"
      "[scan_line]\nmin_top_m = 2.5\n"
      "[map]\nsection_length_m = 0.25\nmin_count = 6\n"
      "[likelihood]\nmodel = paper\nsigma_m = 1.2247\n"
      "[motion]\ncovariance_factor = 4\n"
      "[map_update]\nmoved_m = 0.7\n"
      "[search]\nrecover = false\n");
  ASSERT_EQ(all.sensor.elevations.size(), 3u);
  EXPECT_NEAR(all.sensor.elevations[2], -10 * degree, 1e-12);
  EXPECT_EQ(all.sensor.originZ, 0.957);
  EXPECT_TRUE(all.sensor.upsideDown);
  EXPECT_EQ(all.extraction.method, ExtractionMethod::rangeImage);
  EXPECT_EQ(all.extraction.rangeImage.epsilon, 0.08);
  EXPECT_EQ(all.extraction.rangeImage.maxBottom, 1.4);
  EXPECT_EQ(all.extraction.scanLine.minTop, 2.5);
  EXPECT_EQ(all.map.sectionLength, 0.25);
  EXPECT_EQ(all.map.minCount, 6);
  EXPECT_EQ(all.likelihood.model, LikelihoodModel::paper);
  EXPECT_EQ(all.likelihood.sigma, 1.2247);
  EXPECT_EQ(all.motion.covarianceFactor, 4);
  EXPECT_EQ(all.upkeep.moved, 0.7);
  EXPECT_FALSE(all.localization.recover);
}

// Rules between fields: the message names file, section and key.
TEST(Bindings, RefusesSettingsThatContradictEachOther) {
  const std::map<std::string, std::string> places = {
      {"[sensor]\nmodel = table\n", "[sensor] elevations_deg"},
      {"[sensor]\nmin_range_m = 70\n", "[sensor] max_range_m = 60"},
      {"[sensor]\ncolumns = 80\n", "[sensor] columns = 80"},
      {"[range_image]\nfov_up_deg = -80\n", "[range_image] fov_up_deg = -80"},
      {"[map]\nevery_scan = true\nmiddle = passed\n", "[map] middle = passed"},
      {"[likelihood]\nmodel = floored\nweighted = true\n", "[likelihood] weighted = true"},
      {"[likelihood]\nmodel = floored\nweighted = false\nfloor = 1e-9\n",
       "[likelihood] floor = 1e-09"},
      {"[filter]\ntempering = 0.6\n", "[filter] tempering = 0.6"},
      {"[filter]\nmin_particles = 20000\n", "[filter] min_particles = 20000"},
      {"[start]\nposition_m = 1\n", "[start] position_m = 1"},
      {"[tracking]\ncadence = section\n", "[tracking] cadence = section"},
      {"[runs]\nseed = 4294967294\nruns = 10\n", "[runs] seed = 4294967294"},
      {"[view]\nrate = fast\n", "[view] rate = fast"},
      {"[simulation]\ndetour = 1\n", "[simulation] detour = 1"}};
  for (const auto& [text, place] : places) {
    const std::string message = refusal(text);
    EXPECT_EQ(message.find("t.ini: " + place), 0u) << text << message;
    EXPECT_NE(message.find(": allowed is "), std::string::npos) << message;
  }
}

TEST(Bindings, RefusesRanges) {
  for (const char* text :
       {"[likelihood]\noutlier = 0\n", "[likelihood]\noutlier = 1\n", "[likelihood]\nsigma_m = 0\n",
        "[map]\nmin_count = 0\n", "[map]\nsection_length_m = 0\n", "[range_image]\nrows = 1\n",
        "[range_image]\nmax_range_m = 1001\n", "[scan_line]\nmax_range_m = 301\n",
        "[scan_line]\nmin_confidence = 1.1\n", "[sensor]\nrings = 1\n",
        "[motion]\nxy_per_m = -0.1\n", "[start]\nheading_deg = 181\n"})
    EXPECT_NE(refusal(text), "no error") << text;
}

// A struct is checked by its binding: names and units are those of the INI.
TEST(Bindings, CheckStructsAsTheyCheckFiles) {
  FilterOptions filter;
  filter.extraSigmaYaw = 58 * degree;
  const std::string message = tests::messageOf([&] { checkOptions(filter); });
  EXPECT_EQ(
      message.find(
          "[filter] extra_sigma_deg = 58: allowed is a number 0 to 57 deg (standard deviation"),
      0u)
      << message;
  StartOptions start;
  start.heading = 180 * degree;  // the greatest that is allowed
  EXPECT_NO_THROW(checkOptions(start));
  start.pose = Pose2D{NAN, 0, 0};
  EXPECT_THROW(checkOptions(start), Error);
}

// A program of others binds what it needs, and names the sections that it leaves to ours.
TEST(Bindings, NamedSectionsOfOthersArePassedOver) {
  const ConfigFile file = ConfigFile::fromText(written(AllSettings()), "config.ini");
  ConfigReader reader(file);
  AllSettings settings;
  bind(reader, settings.sensor);
  EXPECT_THROW(reader.finish(), Error);
  std::set<std::string> others;
  for (const WrittenKey& key : keys(written(settings)))
    others.insert(key.name.substr(0, key.name.find('.')));
  EXPECT_NO_THROW(reader.finish(others));
}

TEST(Bindings, TiersFollowEachOther) {
  const auto count = [](Tier most) { return keys(settingsText(AllSettings(), most)).size(); };
  EXPECT_LT(count(Tier::sensor), 25u);
  EXPECT_LT(count(Tier::sensor), count(Tier::tuning));
  EXPECT_LT(count(Tier::tuning), count(Tier::expert));
  EXPECT_EQ(settingsText(AllSettings(), Tier::expert), written(AllSettings()));
}

}  // namespace
}  // namespace polemcl::test_bindings
