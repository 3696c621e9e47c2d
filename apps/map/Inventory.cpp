#include "map/Inventory.h"

#include <expat.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string_view>
#include <unordered_map>

#include <polemcl/core/common/Types.h>
#include "io/file/CsvTable.h"
#include "io/file/InputFile.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

using Columns = std::vector<std::string>;

constexpr std::size_t kLongestName = 256;  ///< bytes: each entry keeps the names of all columns

Columns columnsOf(const io::CsvTable& table, const Columns& asked,
                  const std::filesystem::path& file) {
  if (!asked.empty()) return asked;
  for (const Columns& usual : {Columns{"lon", "lat"}, {"longitude", "latitude"}, {"x", "y"}})
    if (table.find(usual[0]) && table.find(usual[1])) return usual;
  throw Error(file.string() +
              ": no columns lon and lat, longitude and latitude, or x and y; say which hold the "
              "place with --columns EAST,NORTH, and what is between fields with --separator");
}

using Tags = std::map<std::string, std::string>;

struct Meaning {
  const char *key, *value, *kind;  ///< value null: any
};
constexpr std::array<Meaning, 7> kNodes{{{"highway", "street_lamp", "lamp"},
                                         {"power", "pole", "pole"},
                                         {"man_made", "utility_pole", "pole"},
                                         {"natural", "tree", "tree"},
                                         {"traffic_sign", nullptr, "sign"},
                                         {"highway", "traffic_signals", "light"},
                                         {"barrier", "bollard", "bollard"}}};
constexpr std::array<Meaning, 3> kWays{{{"type", "pole", "pole"},
                                        {"type", "traffic_sign", "sign"},
                                        {"type", "traffic_light", "light"}}};

template <std::size_t size>
const char* kindOf(const Tags& tags, const std::array<Meaning, size>& meanings) {
  for (const Meaning& meaning : meanings) {
    const auto tag = tags.find(meaning.key);
    if (tag != tags.end() && (!meaning.value || tag->second == meaning.value)) return meaning.kind;
  }
  return nullptr;
}

const char* attribute(const char** attributes, const char* name) {
  for (; *attributes; attributes += 2)
    if (std::strcmp(*attributes, name) == 0) return attributes[1];
  return nullptr;
}

/// Takes the elements of a file one by one.
class OsmReader {
 public:
  explicit OsmReader(const std::filesystem::path& file)
      : m_file(file), m_parser(XML_ParserCreate(nullptr)) {
    XML_SetUserData(m_parser, this);
    XML_SetElementHandler(m_parser, &OsmReader::begins, &OsmReader::ends);
    XML_SetEntityDeclHandler(m_parser, &OsmReader::declaresEntity);
  }
  ~OsmReader() { XML_ParserFree(m_parser); }
  OsmReader(const OsmReader&) = delete;
  OsmReader& operator=(const OsmReader&) = delete;

  std::vector<InventoryEntry> read() {
    if (const char* why = io::whyNoInput(m_file))
      throw Error("cannot read " + m_file.string() + ": " + why);
    std::ifstream stream(m_file, std::ios::binary);
    if (!stream) throw Error("cannot read " + m_file.string());
    std::array<char, 65536> block;
    do {
      stream.read(block.data(), block.size());
      if (stream.bad()) throw Error("cannot read " + m_file.string());
      const auto status =
          XML_Parse(m_parser, block.data(), static_cast<int>(stream.gcount()), stream.eof());
      if (!m_problem.empty()) throw Error(m_problem);
      if (status != XML_STATUS_OK)
        throw Error(here() + "is no OSM XML: " + XML_ErrorString(XML_GetErrorCode(m_parser)));
    } while (!stream.eof());
    if (!m_isOsm) throw Error(m_file.string() + ": is no OSM XML: no element osm in it");
    return std::move(m_entries);
  }

 private:
  static void begins(void* self, const char* name, const char** attributes) {
    static_cast<OsmReader*>(self)->begin(name, attributes);
  }
  static void ends(void* self, const char* name) { static_cast<OsmReader*>(self)->end(name); }

  /// Entities of a few lines can unfold to gigabytes.
  static void declaresEntity(void* self, const char* name, int, const char*, int, const char*,
                             const char*, const char*, const char*) {
    static_cast<OsmReader*>(self)->fail("declares the entity " + std::string(name) +
                                        "; in OSM XML there are none");
  }

  /// Exceptions must not pass the parser: it stops, and read() throws.
  void fail(const std::string& what) {
    if (m_problem.empty()) m_problem = here() + what;
    XML_StopParser(m_parser, XML_FALSE);
  }
  std::string here() const {
#if XML_MAJOR_VERSION * 100 + XML_MINOR_VERSION >= 209
    return io::at(m_file, XML_GetCurrentLineNumber64(m_parser));
#else
    return io::at(m_file, XML_GetCurrentLineNumber(m_parser));
#endif
  }

  void begin(const std::string& name, const char** attributes) {
    if (name == "osm") {
      m_isOsm = true;
    } else if (name == "node" || name == "way") {
      if (!m_open.empty()) return fail("a " + name + " inside a " + m_open);
      m_open = name;
      m_line = here();
      m_isDeleted = isDeleted(attributes);
      if (name == "node" && !m_isDeleted) beginNode(attributes);
    } else if (m_open.empty()) {
      return;  // a tag of a relation
    } else if (name == "tag") {
      const char *key = attribute(attributes, "k"), *value = attribute(attributes, "v");
      if (key && value) m_tags[key] = value;
    } else if (name == "nd") {
      if (const char* node = attribute(attributes, "ref")) m_members.push_back(node);
    }
  }

  void beginNode(const char** attributes) {
    const char *id = attribute(attributes, "id"), *lon = attribute(attributes, "lon"),
               *lat = attribute(attributes, "lat");
    const auto x = io::parseNumber(lon ? lon : ""), y = io::parseNumber(lat ? lat : "");
    if (!id || !x || !y || !(std::abs(*x) <= 180) || !(std::abs(*y) <= 90))
      return fail("a node needs id, lon and lat, in degrees");
    m_place = {*x, *y};
    m_nodes[id] = m_place;
  }

  /// By JOSM, before the upload.
  static bool isDeleted(const char** attributes) {
    const char *action = attribute(attributes, "action"),
               *visible = attribute(attributes, "visible");
    return std::string_view(action ? action : "") == "delete" ||
           std::string_view(visible ? visible : "") == "false";
  }

  void end(const std::string& name) {
    if (name != m_open) return;
    if (!m_isDeleted) {
      if (name == "node") {
        if (const char* kind = kindOf(m_tags, kNodes)) add(m_place, kind);
      } else if (const char* kind = kindOf(m_tags, kWays)) {
        addWay(kind);
      }
    }
    m_open.clear();
    m_tags.clear();
    m_members.clear();
  }

  void addWay(const char* kind) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    std::size_t count = 0;
    for (const std::string& member : m_members) {
      const auto node = m_nodes.find(member);
      if (node == m_nodes.end()) continue;  // extracts cut ways
      sum += node->second;
      ++count;
    }
    if (count == 0) return fail("a way of a " + std::string(kind) + " has no node of this file");
    add(sum / static_cast<double>(count), kind);
  }

  void add(const Eigen::Vector2d& place, const char* kind) {
    InventoryEntry entry{place, m_tags, m_line};
    entry.properties["kind"] = kind;
    m_entries.push_back(std::move(entry));
  }

  std::filesystem::path m_file;
  XML_Parser m_parser;
  std::string m_problem, m_line;
  std::string m_open;  ///< `node` or `way`: what its tags belong to
  bool m_isOsm = false, m_isDeleted = false;
  Eigen::Vector2d m_place = Eigen::Vector2d::Zero();
  Tags m_tags;
  std::vector<std::string> m_members;
  std::unordered_map<std::string, Eigen::Vector2d> m_nodes;
  std::vector<InventoryEntry> m_entries;
};

}  // namespace

std::vector<InventoryEntry> readCsvInventory(const std::filesystem::path& file,
                                             const Columns& asked, char separator) {
  const io::CsvTable table(file, separator);
  for (const std::string& name : table.names())
    if (name.size() > kLongestName)
      throw Error(file.string() + ": the name of a column has " + std::to_string(name.size()) +
                  " bytes; at most " + std::to_string(kLongestName) + " are allowed");
  const Columns columns = columnsOf(table, asked, file);
  const std::size_t x = table.column(columns[0]), y = table.column(columns[1]);
  std::vector<InventoryEntry> entries;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    InventoryEntry entry{{table.number(row, x), table.number(row, y)}, {}, table.at(row)};
    for (std::size_t c = 0; c < table.names().size(); ++c)
      entry.properties[table.names()[c]] = table.text(row, c);
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::vector<InventoryEntry> readOsmInventory(const std::filesystem::path& file) {
  return OsmReader(file).read();
}

}  // namespace polemcl::apps
