#include "config/Config.h"

#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/config/config_parser.h>

#include <algorithm>
#include <cctype>
#include <numeric>

#include "config/PlainText.h"
#include "config/RemovedSettings.h"
#include "io/file/AtomicFile.h"
#include "io/file/FileKind.h"
#include "io/file/InstalledFiles.h"
#include "io/file/TextFile.h"

namespace polemcl {
namespace {

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Removes a comment: `#`, `;` or `//` at the start or after a blank.
std::string withoutComment(const std::string& line) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (i > 0 && line[i - 1] != ' ' && line[i - 1] != '\t') continue;
    if (line[i] == '#' || line[i] == ';' || line.compare(i, 2, "//") == 0)
      return std::string(io::trimmed(line.substr(0, i)));
  }
  return std::string(io::trimmed(line));
}

/// Letters to change, to add or to drop until both are the same (Levenshtein).
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

/// The words that are known, and of these or the others the one that was probably meant.
std::string knownWords(std::set<std::string> words, const std::string& found,
                       const std::set<std::string>& others = {}) {
  const std::string known = io::joined(words);
  words.insert(others.begin(), others.end());
  const auto distance = [&](const std::string& word) { return editDistance(lower(found), word); };
  const auto nearest =
      std::min_element(words.begin(), words.end(),
                       [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  std::string text = "known are: " + known;
  if (nearest != words.end() && distance(*nearest) <= 2) text += "; is " + *nearest + " meant?";
  return text;
}

/// Checks the lines before MRPT's parser gets them; rejects those that it would ignore silently.
class Lint {
 public:
  explicit Lint(std::string name) : m_name(std::move(name)) {}

  void line(std::size_t number, const std::string& raw) {
    const std::string text = withoutComment(raw);
    if (text.empty()) return;
    const std::string where = m_name + ":" + std::to_string(number) + ": ";
    if (text.front() == '[') return section(text, number, where);
    const auto equals = text.find('=');
    const std::string key(io::trimmed(text.substr(0, equals)));
    if (equals == std::string::npos || key.empty())
      throw Error(where + "'" + text + "' is neither [section], key = value, nor a # comment");
    if (m_section.empty())
      throw Error(where + "key '" + key + "' stands before the first [section]");
    once(m_keys, lower(m_section + "]" + key), number,
         where + "key '" + key + "' of [" + m_section + "]");
    m_clean += text + "\n";
  }
  const std::string& clean() const { return m_clean; }

 private:
  void section(const std::string& text, std::size_t number, const std::string& where) {
    if (text.back() != ']' || text.size() < 3)
      throw Error(where + "'" + text + "' is not a section; write [name]");
    m_section = std::string(io::trimmed(text.substr(1, text.size() - 2)));
    once(m_sections, lower(m_section), number, where + "section [" + m_section + "]");
    m_clean += "[" + m_section + "]\n";
  }
  static void once(std::map<std::string, std::size_t>& seen, const std::string& what,
                   std::size_t number, const std::string& message) {
    const auto [entry, isNew] = seen.emplace(what, number);
    if (!isNew)
      throw Error(message + " is given twice, first in line " + std::to_string(entry->second) +
                  "; remove one");
  }

  std::string m_name, m_section, m_clean;
  std::map<std::string, std::size_t> m_sections, m_keys;  ///< lower case -> line
};

/// Whether two values are the same, as numbers if both are.
bool sameValue(const std::string& a, const std::string& b) {
  char *endA = nullptr, *endB = nullptr;
  const double numberA = std::strtod(a.c_str(), &endA), numberB = std::strtod(b.c_str(), &endB);
  const bool numbers = !a.empty() && !b.empty() && *endA == 0 && *endB == 0;
  return numbers ? std::abs(numberA - numberB) <= 1e-9 * std::abs(numberB) : lower(a) == lower(b);
}

/// The fault of a setting that version 1 had: empty if it has the value that is fixed now.
/// \return Nothing for a key that version 1 had not.
std::optional<std::string> faultOfRemoved(const std::string& section, const std::string& key,
                                          const std::string& value) {
  static const ConfigFile removed = ConfigFile::fromText(removedSettings, "removed settings");
  const auto& source = removed.source();
  if (!source.keyExists(section, key)) return std::nullopt;
  const std::string fixed = withoutComment(source.read_string(section, key, ""));
  if (sameValue(value, fixed)) return "";
  return "is no setting since version 2; it is always " + fixed + ". Remove the line";
}

std::string installedText() {
  const bool isThere = !io::fileOfDataFolder("kitti.ini", "config").empty();
  return isThere ? "; installed are kitti.ini, hdl32e.ini and others" : "";
}

}  // namespace

ConfigFile ConfigFile::fromText(const std::string& text, const std::string& name) {
  Lint lint(name);
  ConfigFile file;
  file.m_name = name;
  requirePlain(text, name);
  try {
    const std::string expanded = mrpt::config::config_parser(text);  // @define
    // CConfigFileMemory expands once more: what @define stands for must not be another.
    if (expanded.find("@define") != std::string::npos)
      throw Error(name + ": @define stands for another; write its value");
    std::size_t number = 0;
    for (std::size_t at = 0; at < expanded.size();) {
      const std::size_t end = std::min(expanded.find('\n', at), expanded.size());
      lint.line(++number, expanded.substr(at, end - at));
      at = end + 1;
    }
    file.m_source = std::make_shared<mrpt::config::CConfigFileMemory>(lint.clean());
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(name + ": " + error.what());
  }
  return file;
}

ConfigFile ConfigFile::read(const std::string& path) {
  if (const std::string kind = io::otherKind(path, ".ini"); !kind.empty())
    throw Error(path + ": " + kind + "not an INI file of settings" + installedText());
  std::string text;
  for (const auto& line : io::readLines(path)) text += line + "\n";
  return fromText(text, path);
}

ConfigFile ConfigFile::readInstalled(const std::string& pathOrName) {
  const std::filesystem::path file = io::installedFile(pathOrName, "config");
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    throw Error("cannot read " + pathOrName + ": no such file here, and none of that name is " +
                "installed" + installedText());
  return read(file.string());
}

void ConfigFile::set(const std::string& assignment) {
  const auto equals = assignment.find('=');
  const auto dot = assignment.substr(0, equals).rfind('.');  // labels in sections may have dots
  const auto part = [&](std::size_t from, std::size_t to) {
    return std::string(io::trimmed(assignment.substr(from, to - from)));
  };
  if (equals == std::string::npos || dot >= equals || part(0, dot).empty() ||
      part(dot + 1, equals).empty())
    throw Error("'" + assignment + "' is not an assignment; write section.key=value, as in " +
                "filter.particles=500");
  m_source->write(part(0, dot), part(dot + 1, equals), part(equals + 1, assignment.size()));
  m_changed = true;
}

ConfigReader::ConfigReader(const ConfigFile& file)
    : m_owned(std::shared_ptr<const mrpt::config::CConfigFileBase>(file.m_source)),
      m_source(&file.source()),
      m_name(file.name() + (file.m_changed ? ", changed with --set" : "")) {}

ConfigReader::ConfigReader(const mrpt::config::CConfigFileBase& source, const std::string& name,
                           const std::string& fixedSection)
    : m_source(&source), m_name(name), m_fixedSection(fixedSection) {
  if (!fixedSection.empty()) openSection({});
}

void ConfigReader::openSection(const std::string&) {
  if (!m_fixedSection.empty()) m_section = m_fixedSection;
  m_known[lower(m_section)];
}

void ConfigReader::knownElsewhere(std::initializer_list<std::string> keys) {
  for (const auto& key : keys) m_known[lower(m_section)].insert(lower(key));
}

std::optional<std::string> ConfigReader::exchange(const Key& key, const std::string&) {
  m_known[lower(m_section)].insert(lower(key.name));
  if (!m_source->keyExists(m_section, key.name)) return std::nullopt;
  return withoutComment(m_source->read_string(m_section, key.name, ""));
}

std::string ConfigReader::place() const {
  return m_name + ": ";
}

void ConfigReader::finish(const std::set<std::string>& others) const {
  const auto unknown = unknownEntries(others);
  if (!unknown.empty()) throw Error(unknown.front());
}

std::vector<std::string> ConfigReader::unknownEntries(const std::set<std::string>& others) const {
  std::vector<std::string> messages;
  std::vector<std::string> sections;
  m_source->getAllSections(sections);
  for (const auto& section : sections) {
    const auto known = m_known.find(lower(section));
    const bool bound = known != m_known.end();
    if (!bound && (others.count(lower(section)) > 0 || !m_fixedSection.empty())) continue;
    std::vector<std::string> keys;
    m_source->getAllKeys(section, keys);
    bool removed = !bound && !keys.empty();
    for (const auto& key : keys) {
      if (bound && known->second.count(lower(key))) continue;
      const std::string value = withoutComment(m_source->read_string(section, key, ""));
      const auto fault = faultOfRemoved(lower(section), lower(key), value);
      removed = removed && fault;
      if (fault == "" || (!bound && !fault)) continue;
      messages.push_back(place() + "[" + section + "] " + key + " = " + value + ": " +
                         (fault ? *fault : "key is not known; " + knownWords(known->second, key)));
    }
    if (!bound && !removed) messages.push_back(place() + unknownSection(section, others));
  }
  return messages;
}

std::string ConfigReader::unknownSection(const std::string& section,
                                         const std::set<std::string>& others) const {
  std::set<std::string> known;
  for (const auto& [name, keys] : m_known) known.insert(name);
  return "section [" + section + "] is not known; " +
         (section.find(':') == std::string::npos
              ? knownWords(known, section, others)
              : "[vehicle] lidars must list the label behind the colon; known are: " +
                    io::joined(known));
}

void ConfigWriter::openSection(const std::string& comment) {
  const auto same = [this](const Section& section) { return section.name == m_section; };
  auto found = std::find_if(m_sections.begin(), m_sections.end(), same);
  if (found == m_sections.end())
    found = m_sections.insert(m_sections.end(), {m_section, comment, {}});
  m_open = static_cast<std::size_t>(found - m_sections.begin());
}

std::optional<std::string> ConfigWriter::exchange(const Key& key, const std::string& current) {
  if (key.tier > m_most) return std::nullopt;
  if (withoutComment(current) != current || current.find_first_of("\n\r$\\") != std::string::npos)
    throw Error(
        place() + "[" + m_section + "] " + key.name + " = " + current +
        ": cannot be written to an INI file (comment marks, line breaks, $, \\ or blanks at "
        "its ends)");
  std::string line = key.name + " = " + current;
  if (line.size() < 32) line.resize(32, ' ');
  line += "  // " + key.comment;
  const std::string unit = key.unit.empty() ? "" : key.unit + "; ";
  m_sections.at(m_open).lines += line + " [" + unit + key.allowed + "]\n";
  return std::nullopt;
}

std::string ConfigWriter::place() const {
  return "settings: ";
}

std::string ConfigWriter::text() const {
  std::string text;
  for (const auto& section : m_sections) {
    if (section.lines.empty()) continue;
    text += (text.empty() ? "# " : "\n# ") + section.comment + "\n[" + section.name + "]\n" +
            section.lines;
  }
  return text;
}

void ConfigWriter::save(const std::string& path) const {
  io::writeFile(path, text());
}

}  // namespace polemcl
