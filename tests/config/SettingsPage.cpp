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
- `--set SECTION.KEY=VALUE` puts a value in the place of the file's.
- `--config` takes a path or the name of an installed file. `config/nclt.ini`, as these pages write it, and `nclt.ini` both work in any folder: what is not
  there is looked for in `/usr/share/polemcl/config`.
- `--print-config` prints the effective settings of the tiers *sensor* and *tuning*, `--print-config --all` all of them;
  the program then ends.
- The defaults were chosen by measuring, between LiDARs and drives: one may be better for yours. Those of `config/paper/` are the paper's.
- Angles are in degrees in files and rounded on these pages. A number outside the allowed values is refused, with file,
  section, key and what is allowed. Unknown sections and keys are refused as well, but for the sections of the simulator
  and of the view in programs that have no use for them.

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
These pages are made from the source code; a test compares them. To make them anew:
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

/// The page of a group, and its rows of the table of sections.
struct GroupPage {
  std::string text, rows;
};
GroupPage pageOf(const Group& group, const PageBinder& binder) {
  GroupPage page;
  std::string first = "[" + group.title + "](" + group.name + ".md)";
  page.text =
      "# Settings: " + group.title + "\n\n[Settings](settings.md) says how an INI file works.\n";
  std::istringstream names(group.sections);
  for (std::string name; names >> name;) {
    const PageBinder::Section& section = binder.section(name);
    page.text += "\n## [" + name + "]\n" + section.comment + ".\n\n" + s_columns + section.rows;
    page.rows += "| " + first + " | [`[" + name + "]`](" + group.name + ".md#" + name + ") | " +
                 cell(section.comment) + " |\n";
    first.clear();
  }
  if (group.name == s_labelled) {
    page.text += s_lidars;
    page.rows += "| | [`[sensor:LABEL]` and others](" + group.name +
                 ".md#sensorlabel-range_imagelabel-scan_linelabel) | What differs for one of "
                 "several LiDARs |\n";
  }
  return page;
}

/// The table of the settings that people set.
std::string usualSettings(const PageBinder& binder) {
  std::string text = "\n## The fifteen that people set\n| section |" + std::string(s_columns + 1);
  text.insert(text.find("|---"), "|---");
  for (const std::string& name : kUsual) {
    const std::size_t dot = name.find('.');
    const std::string sectionName = name.substr(0, dot), start = "| `" + name.substr(dot + 1) + "`";
    const std::string& rows = binder.section(sectionName).rows;
    const std::size_t at = rows.find(start);
    if (at == rows.npos) throw Error("there is no setting " + name);
    text += "| `[" + sectionName + "]` " + rows.substr(at, rows.find('\n', at) + 1 - at);
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
  index += "| page | section | sets |\n|---|---|---|\n";
  for (const Group& group : groups()) {
    const GroupPage page = pageOf(group, binder);
    pages[group.name + ".md"] = page.text;
    index += page.rows;
  }
  index += s_foot;
  return pages;
}

}  // namespace polemcl::apps
