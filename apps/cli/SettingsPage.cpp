#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <polemcl/core/common/Binder.h>
#include "cli/Settings.h"

namespace polemcl::apps {
namespace {

constexpr const char* s_head = R"(# Settings

All programs with `--config` read one INI file. It needs only the keys that differ from the defaults below.
`--set SECTION.KEY=VALUE` puts a value in the place of the file's. `--print-config` prints the effective settings of the
tiers *sensor* and *tuning*, `--print-config --all` all of them; the program then ends.

| tier | who sets it |
|---|---|
| sensor | you, for each sensor, mounting and vehicle |
| tuning | you, when results are not good enough |
| expert | nobody, except to study the method: the measured value serves everywhere |

The defaults are the settings that were measured as the best. Those of `config/paper/` are the paper's. Angles are in degrees in
files and rounded here. A number outside the allowed values is refused, with file, section, key and what is allowed.

This page is made from the source code; a test compares it. To make it anew:
`POLEMCL_WRITE_PAGES=1 build/bin/test_config --gtest_filter='SettingsPage.*'`
)";

/// Sections that exist only for the labels that are listed.
constexpr const char* s_lidars = R"(
## [sensor:LABEL], [range_image:LABEL], [scan_line:LABEL]
For each label that `[vehicle] lidars` lists. Their keys are those of the sections without a label; what they leave out
is as it is there. `[sensor:LABEL]` has one more:

| key | default | unit | allowed | tier | meaning |
|---|---|---|---|---|---|
| `pose` |  | m and deg | six numbers, or none | sensor | x y z yaw_deg pitch_deg roll_deg of the LiDAR on the vehicle; empty: that of its observations |
)";

/// The text inside a cell of a table.
std::string cell(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '|') safe += '\\';
    safe += c;
  }
  return safe;
}

class PageBinder : public Binder {
 public:
  std::string text() const {
    std::string text = s_head;
    for (const Section& section : m_sections)
      text +=
          "\n## [" + section.name + "]\n" + section.comment +
          ".\n\n| key | default | unit | allowed | tier | meaning |\n|---|---|---|---|---|---|\n" +
          section.rows;
    return text;
  }

 protected:
  void openSection(const std::string& comment) override {
    const auto same = [this](const Section& section) { return section.name == m_section; };
    auto found = std::find_if(m_sections.begin(), m_sections.end(), same);
    if (found == m_sections.end())
      found = m_sections.insert(m_sections.end(), {m_section, comment, {}});
    m_open = static_cast<std::size_t>(found - m_sections.begin());
  }
  std::optional<std::string> exchange(const Key& key, const std::string& current) override {
    std::string value = current;
    if (key.unit == "deg" && !value.empty() && value.find(' ') == std::string::npos) {
      char rounded[32];
      std::snprintf(rounded, sizeof rounded, "%.4g", std::strtod(value.c_str(), nullptr));
      value = rounded;
    }
    m_sections[m_open].rows += "| `" + key.name + "` | " + cell(value) + " | " + cell(key.unit) +
                               " | " + cell(key.allowed) + " | " + name(key.tier) + " | " +
                               cell(key.comment) + " |\n";
    return std::nullopt;
  }
  std::string place() const override { return "settings: "; }

 private:
  struct Section {
    std::string name, comment, rows;
  };
  std::vector<Section> m_sections;
  std::size_t m_open = 0;
};

}  // namespace

std::string settingsPage() {
  PageBinder binder;
  Settings defaults;
  bind(binder, defaults);
  return binder.text() + s_lidars;
}

}  // namespace polemcl::apps
