/// \file test_SettingRanges.cpp
/// \brief Each number of each settings section is refused just outside of its range, and so are
/// values that contradict each other. What a message must say stands here once, for all rooms.

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "cli/Settings.h"
#include "config/Config.h"
#include "support/Refusal.h"

namespace polemcl::test_setting_ranges {
namespace {

/// A key that takes numbers or words, as the writer gives it: `key = value  // meaning [unit;
/// allowed]`.
struct Key {
  std::string section, name, allowed;
  std::size_t numbers = 1;
};

std::vector<Key> boundKeys() {
  ConfigWriter writer;
  apps::AllSettings settings;
  bind(writer, settings);
  std::vector<Key> result;
  std::istringstream text(writer.text());
  std::string section;
  for (std::string line; std::getline(text, line);) {
    if (!line.empty() && line[0] == '[') section = line.substr(1, line.size() - 2);
    const auto equals = line.find(" = "), comment = line.find("  //"), bracket = line.rfind('[');
    if (line.empty() || line[0] == '#' || equals == std::string::npos) continue;
    std::string allowed = line.substr(bracket + 1, line.size() - bracket - 2);
    if (const auto unit = allowed.find("; "); unit != std::string::npos) allowed.erase(0, unit + 2);
    if (allowed == "text") continue;
    const std::string value = line.substr(equals + 3, comment - equals - 3);
    std::istringstream words(value);
    std::size_t numbers = 0;
    for (std::string word; words >> word;) ++numbers;
    result.push_back({section, line.substr(0, equals), allowed, std::max<std::size_t>(1, numbers)});
  }
  return result;
}

/// Values just outside of what is allowed: "0 to 57", "> 0 and <= 1", ">= 1", "a | b".
std::vector<std::string> outside(std::string allowed) {
  if (allowed.rfind("each ", 0) == 0) allowed.erase(0, 5);
  if (allowed.find(" | ") != std::string::npos || allowed == "true or false") return {"otherwise"};
  std::vector<std::string> values{"nan", "inf", "1x"};
  if (allowed == "any number") return values;
  const auto add = [&](double bound, double step) {
    std::ostringstream text;
    text.precision(17);
    text << bound + step * std::max(1.0, std::abs(bound));
    values.push_back(text.str());
  };
  if (const auto to = allowed.find(" to "); to != std::string::npos) {
    add(std::stod(allowed), -0.001);
    add(std::stod(allowed.substr(to + 4)), 0.001);
    return values;
  }
  std::istringstream words(allowed);
  for (std::string sign, bound; words >> sign;) {
    if (sign == "and" || !(words >> bound)) continue;
    const double step = sign.back() == '=' ? 0.001 : 0;
    add(std::stod(bound), sign[0] == '>' ? -step : step);
  }
  return values;
}

std::string refusal(const std::string& text) {
  ConfigReader reader(ConfigFile::fromText(text, "t.ini"));
  apps::AllSettings settings;
  return tests::messageOf([&] {
    bind(reader, settings);
    reader.finish();
  });
}

TEST(SettingRanges, NumbersOutsideAreRefusedWithTheirPlaceAndWhatIsAllowed) {
  std::size_t tried = 0;
  for (const Key& key : boundKeys())
    for (const std::string& bad : outside(key.allowed)) {
      std::string value = bad;
      for (std::size_t i = 1; i < key.numbers; ++i) value += " " + bad;
      const std::string message =
          refusal("[" + key.section + "]\n" + key.name + " = " + value + "\n");
      EXPECT_HAS(message, "[" + key.section + "] " + key.name + " = " + value);
      EXPECT_HAS(message, "allowed is ");
      ++tried;
    }
  EXPECT_GT(tried, 400u);
}

TEST(SettingRanges, ValuesThatContradictEachOtherAreRefused) {
  const std::vector<std::pair<std::string, std::string>> rules = {
      {"[range_image]\nrows = 1\n", "rows = 1: allowed is 0, or at least 2"},
      {"[range_image]\ncolumns = 15\n", "columns = 15: allowed is 0, or at least 16"},
      {"[range_image]\nfov_up_deg = -20\nfov_down_deg = -20\n", "[range_image] fov_up_deg = -20"},
      {"[range_image]\nmin_z_m = 1\nmax_z_m = 1\n", "max_z_m = 1: allowed is more than min_z_m"},
      {"[scan_line]\nmax_radius_m = 0.02\n", "max_radius_m = 0.02: allowed is more than 0.02 m"},
      {"[sensor]\nmodel = hdl128\n", "model = hdl128"},
      {"[sensor]\nmodel = table\nelevations_deg = 1\ncolumns = 900\n", "[sensor] elevations_deg"},
      {"[sensor]\nmodel = table\nelevations_deg = 1 -1\n", "[sensor] columns = 0"},
      {"[sensor]\nmodel = table\nelevations_deg = 1 -1\ncolumns = 900\nlower_elevations_deg = -9\n",
       "[sensor] lower_elevations_deg"},
      {"[sensor]\nmodel = table\nelevations_deg = 1 -1\ncolumns = 900\nlower_elevations_deg = 0 "
       "0\n",
       "block below all"},
      {"[sensor]\nmodel = uniform\nrings = 16\nfov_up_deg = -1\nfov_down_deg = -1\ncolumns = 900\n",
       "[sensor] fov_up_deg"},
      {"[sensor]\ncolumns = 89\n",
       "columns = 89: allowed is 0 for those of the model, or at least 90"},
      {"[sensor]\nmin_range_m = 5\nmax_range_m = 5\n", "[sensor] max_range_m = 5"},
      {"[likelihood]\noutlier = 1e-9\nfar_outlier = 0.01\n", "[likelihood] far_outlier = 0.01"},
      {"[filter]\ntempering = 0.6\n", "tempering = 0.6: allowed is resample_below or less"},
      {"[filter]\nregularization = 0\n", "[filter] tempering"},
      {"[filter]\nadaptive = true\nresample_below = 0\ntempering = 0\n",
       "adaptive = true: allowed is false where resample_below = 0"},
      {"[filter]\nmin_particles = 20000\n",
       "min_particles = 20000: allowed is max_particles or less"},
      {"[filter]\nparticle = 10\n", "particle"},
      {"[start]\nposition_m = 1\n", "position_m = 1: allowed is two numbers"},
      {"[runs]\nseed = 4294967295\n", "[runs] seed = 4294967295"},
      {"[simulation]\ndetour = 1\n", "detour = 1: allowed is [world] side_streets or less"},
  };
  for (const auto& [text, part] : rules) {
    const std::string message = refusal(text);
    EXPECT_HAS(message, part) << text;
    EXPECT_EQ(message.find("t.ini: "), 0u) << message;
  }
}

}  // namespace
}  // namespace polemcl::test_setting_ranges
