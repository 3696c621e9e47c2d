#include "config/SettingsPage.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <sstream>
#include <vector>

#include "cli/Settings.h"
#include "core/common/Binder.h"

namespace polemcl::apps {
namespace {

constexpr const char* s_head = R"(# Settings

All programs with `--config` read one INI file. It needs only the keys that differ from their defaults:

```ini
[sensor]
model = hdl32e      ; which LiDAR
height_m = 1.0      # metres above the ground
```
- `--set SECTION.KEY=VALUE` replaces a value of the file.
- `--config` takes a path or the name of an installed file: `nclt.ini` and `config/nclt.ini` work in any folder.
- `--print-config` prints the settings in effect, without those of the tier *expert*; with `--all` all of them.
- The defaults were chosen by measuring, between LiDARs and drives: another value may be better for yours. Those of `config/paper/` are those of its authors' program ([paper](paper.md)).
- Angles are in degrees, and rounded on these pages.
- Unknown sections and keys are refused, and numbers outside the allowed values. Sections of the simulator and of the view may stand in the file of any program.

| tier | who sets it |
|---|---|
| sensor | you, for each sensor, mounting and vehicle |
| tuning | you, when results are not good enough |
| expert | nobody, except to study the method: the measured value serves everywhere |

Which key helps against which fault: [tuning by symptom](tuning.md).
)";
/// Those that people set, as `section.key`; they come first.
const std::vector<std::string> kUsual{"sensor.model",
                                      "sensor.height_m",
                                      "sensor.turn",
                                      "sensor.clock_offset_s",
                                      "sensor.min_range_m",
                                      "sensor.upside_down",
                                      "sensor.origin",
                                      "scan_line.min_top_m",
                                      "scan_line.max_range_m",
                                      "map.section_length_m",
                                      "map.min_count",
                                      "likelihood.sigma_m",
                                      "motion.covariance_factor",
                                      "start.radius_m",
                                      "filter.particles"};
constexpr const char* s_columns =
    "| key | meaning | default | unit | allowed | tier |\n|---|---|---|---|---|---|\n";
constexpr const char* s_foot = R"(
These pages are made from the source code:
`POLEMCL_WRITE_PAGES=1 build/bin/test_config --gtest_filter='SettingsPage.*'`
)";

/// A page, and the sections on it.
struct Group {
  std::string name, title, sections;
};
const std::vector<Group>& groups() {
  static const std::vector<Group> groups = {
      {"settings-sensor", "Sensor and extraction", "sensor extraction scan_line vehicle"},
      {"settings-maps", "Maps", "map map_update"},
      {"settings-localization", "Localization",
       "start filter likelihood tracking motion runs view"},
      {"settings-health", "Health, search, odometry",
       "health search odometry_monitor odometry_calibration"},
      {"settings-simulation", "Simulation", "simulation world realism"},
      {"settings-paper", "The paper's extraction", "range_image"}};
  return groups;
}
constexpr const char* s_labelled = "settings-sensor";  // has also what s_lidars says

/// Sections that exist only for the labels that are listed.
constexpr const char* s_lidars = R"(
## [sensor:LABEL], [range_image:LABEL], [scan_line:LABEL]
For each label that `[vehicle] lidars` lists. Their keys are those of the sections without a label; what they leave out
is as it is there. `[sensor:LABEL]` has one more:

| key | meaning | default | unit | allowed | tier |
|---|---|---|---|---|---|
| `pose` | x y z yaw_deg pitch_deg roll_deg of the LiDAR on the vehicle; empty: that of its observations |  | m and deg | six numbers, or none | sensor |
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
  struct Section {
    std::string name, comment, rows;
  };
  const Section& section(const std::string& name) const {
    const std::size_t at = indexOf(name);
    if (at == m_sections.size()) throw Error("there are no settings [" + name + "]");
    return m_sections[at];
  }
  const std::vector<Section>& sections() const { return m_sections; }

 protected:
  void openSection(const std::string& comment) override {
    m_open = indexOf(m_section);
    if (m_open == m_sections.size()) m_sections.push_back({m_section, comment, {}});
  }
  std::optional<std::string> exchange(const Key& key, const std::string& current) override {
    std::string value = current;
    if (key.unit == "deg" && !value.empty() && value.find(' ') == std::string::npos) {
      char rounded[32];
      std::snprintf(rounded, sizeof rounded, "%.4g", std::strtod(value.c_str(), nullptr));
      value = rounded;
    }
    std::string& rows = m_sections[m_open].rows;
    rows += "| `" + key.name + "`";
    for (const std::string& text :
         {key.comment, value, key.unit, key.allowed, std::string(name(key.tier))})
      rows += " | " + cell(text);
    rows += " |\n";
    return std::nullopt;
  }
  std::string place() const override { return "settings: "; }

 private:
  /// Place of the section with this name, or the number of sections.
  std::size_t indexOf(const std::string& name) const {
    const auto found = std::find_if(m_sections.begin(), m_sections.end(),
                                    [&](const Section& section) { return section.name == name; });
    return static_cast<std::size_t>(found - m_sections.begin());
  }
  std::vector<Section> m_sections;
  std::size_t m_open = 0;
};

/// The page of a group, and its row of the table of sections.
struct GroupPage {
  std::string text, row;
};
GroupPage pageOf(const Group& group, const PageBinder& binder) {
  GroupPage page;
  page.row = "| [" + group.title + "](" + group.name + ".md) |";
  page.text =
      "# Settings: " + group.title + "\n\n[Settings](settings.md) says how an INI file works.\n";
  std::istringstream names(group.sections);
  for (std::string name; names >> name;) {
    const PageBinder::Section& section = binder.section(name);
    page.text += "\n## [" + name + "]\n" + section.comment + ".\n\n" + s_columns + section.rows;
    page.row += (page.row.back() == '|' ? " [`[" : ", [`[") + name + "]`](" + group.name + ".md#" +
                name + ")";
  }
  if (group.name == s_labelled) {
    page.text += s_lidars;
    page.row += ", [`[sensor:LABEL]` and others](" + group.name +
                ".md#sensorlabel-range_imagelabel-scan_linelabel)";
  }
  page.row += " |\n";
  return page;
}

/// The table of the settings that people set, without what is allowed and the tier.
std::string usualSettings(const PageBinder& binder) {
  std::string text =
      "\n## The fifteen that people set\n| section | key | meaning | default | unit |\n"
      "|---|---|---|---|---|\n";
  for (const std::string& name : kUsual) {
    const std::size_t dot = name.find('.');
    const std::string sectionName = name.substr(0, dot), start = "| `" + name.substr(dot + 1) + "`";
    const std::string& rows = binder.section(sectionName).rows;
    const std::size_t at = rows.find(start);
    if (at == rows.npos) throw Error("there is no setting " + name);
    std::size_t end = at;
    for (int column = 0; column < 4; ++column) end = rows.find(" | ", end + 1);
    text += "| `[" + sectionName + "]` " + rows.substr(at, end - at) + " |\n";
  }
  return text + "\n## Sections\n";
}

/// \throws Error naming a section that is on no page or on two.
void checkGroups(const PageBinder& binder) {
  std::istringstream all(std::accumulate(
      groups().begin(), groups().end(), std::string(),
      [](const std::string& names, const Group& group) { return names + " " + group.sections; }));
  std::map<std::string, int> pages;
  for (std::string name; all >> name;) ++pages[name];
  for (const PageBinder::Section& section : binder.sections())
    if (pages[section.name] != 1)
      throw Error("settings [" + section.name +
                  "] must be on one page: list the section once in groups() of SettingsPage.cpp");
}

}  // namespace

std::map<std::string, std::string> settingsPages() {
  PageBinder binder;
  AllSettings defaults;
  bind(binder, defaults);
  checkGroups(binder);
  std::map<std::string, std::string> pages;
  std::string& index = pages["settings.md"] = s_head;
  index += usualSettings(binder);
  index += "| page | sections |\n|---|---|\n";
  for (const Group& group : groups()) {
    const GroupPage page = pageOf(group, binder);
    pages[group.name + ".md"] = page.text;
    index += page.row;
  }
  index += s_foot;
  return pages;
}

}  // namespace polemcl::apps
