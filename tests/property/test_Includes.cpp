/// \file test_Includes.cpp
/// \brief Reads every source of the library and the programs. Checks the rules of
/// share/doc/architecture.md: rooms include only rooms above them, files and mains stay small.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace polemcl::test_includes {

namespace fs = std::filesystem;

namespace {

const fs::path kTop = POLEMCL_SOURCE_DIR;

constexpr std::size_t kMostLines = 500;

/// Rooms and sub-rooms in the order of the document. A file may include headers of its own line and
/// of the lines above. Lines with the same first part belong to one big room.
const std::vector<std::string> kOrder{
    "core/common",
    "core/sensor",
    "core/extraction/range_image",
    "core/extraction/scan_line",
    "core/extraction",
    "core/mapping",
    "core/localization",
    "core/global_localization",
    "core/slam",
    "core/evaluation",
    "io/file",
    "io/data",
    "io/rosbag",
    "io/dataset",
    "io/map",
    "config",
    "mrpt/common",
    "mrpt/drawing",
    "mrpt/observation",
    "mrpt/map",
    "mrpt/rawlog",
    "mrpt/filter",
    "mrpt/live",
    "localizer",
    "sim/common",
    "sim/world",
    "sim/lidar",
    "sim/drive",
    "sim/detections",
    "report/picture",
    "report/scene",
    "report/batch",
    "apps/cli",
    "apps/import",
    "apps/extract",
    "apps/map",
    "apps/localize",
    "apps/simulate",
    "apps/eval",
    "apps/batch",
    "apps/labels",
    "apps/programs",
    "apps/python",
};

/// Big rooms that a big room must not use, although they are above it.
const std::map<std::string, std::set<std::string>> kStrangers{{"sim", {"mrpt"}}};
/// The laboratory: big rooms that simulate and judge. Only these rooms outside of it use it.
const std::set<std::string> kLaboratory{"sim"}, kLaboratoryUsers{"apps/simulate", "apps/eval"};
/// Its settings, which the settings of all programs hold: one INI serves all programs.
const std::pair<std::string, std::string> kLaboratorySettings{"apps/cli",
                                                              "sim/common/SimulationOptions.h"};
/// A line above that a room must not use: two methods for the same purpose.
const std::map<std::string, std::set<std::string>> kStrangerRooms{
    {"core/extraction/scan_line", {"core/extraction/range_image"}}};
/// Settings and report of the surrounding room, shared by its sub-rooms.
const std::map<std::string, std::set<std::string>> kSharedHeaders{
    {"core/extraction",
     {"CovarianceScale.h", "ExtractionOptions.h", "ExtractionReport.h", "PoleClassifier.h",
      "VisibilityRange.h"}}};

struct Source {
  fs::path path;  ///< relative to the top folder
  std::vector<std::string> lines;
};

std::vector<std::string> readLines(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

bool isSource(const fs::path& path) {
  static const std::set<std::string> suffixes{".h",   ".hh", ".hpp", ".hxx", ".inl",
                                              ".ipp", ".c",  ".cc",  ".cpp", ".cxx",
                                              ".py",  ".sh", ".in",  ".js",  ".cmake"};
  return suffixes.count(path.extension().string()) > 0 || path.filename() == "CMakeLists.txt";
}

std::vector<Source> sourcesBelow(const std::vector<std::string>& folders) {
  std::vector<Source> sources;
  for (const std::string& folder : folders) {
    if (!fs::exists(kTop / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(kTop / folder)) {
      // share/demo/out is output of the demo, not source.
      const fs::path path = fs::relative(entry.path(), kTop);
      if (entry.is_regular_file() && isSource(path) &&
          path.string().rfind("share/demo/out", 0) != 0) {
        sources.push_back({path, readLines(entry.path())});
      }
    }
  }
  std::sort(sources.begin(), sources.end(),
            [](const Source& a, const Source& b) { return a.path < b.path; });
  return sources;
}

/// Position in the order; its size if it is not a room.
std::size_t placeOf(const std::string& room) {
  return std::find(kOrder.begin(), kOrder.end(), room) - kOrder.begin();
}

bool isRoom(const std::string& name) {
  return placeOf(name) < kOrder.size();
}

std::string bigRoomOf(const std::string& room) {
  return room.substr(0, room.find('/'));
}

/// Public headers that stand above all rooms.
const std::set<std::string> kAboveRooms{"polemcl/export.h", "polemcl/version.h"};
/// Public headers that include the others, for users.
const std::set<std::string> kAllTogether{"core.h", "polemcl.h"};

bool isPublic(const fs::path& path) {
  return path.generic_string().rfind("libpolemcl/include/polemcl/", 0) == 0;
}

/// Public headers in no room: the marks, and those that include all others.
bool isAboveRooms(const fs::path& path) {
  return path.parent_path() == "libpolemcl/include/polemcl";
}

/// The room of a file; empty for other files.
std::string roomOf(const fs::path& path) {
  const std::string folder = path.parent_path().generic_string();
  for (const std::string base : {"libpolemcl/src/", "libpolemcl/include/polemcl/"})
    if (folder.rfind(base, 0) == 0) return folder.substr(base.size());
  return folder.rfind("apps/", 0) == 0 ? folder : "";
}

/// The room of one of our headers, from the text of its include.
std::string roomOfHeader(const std::string& header) {
  const fs::path path = header.rfind("polemcl/", 0) == 0 ? header.substr(8) : header;
  const std::string folder = path.parent_path().generic_string();
  return isRoom(folder) ? folder : "apps/" + folder;
}

/// The name between brackets or quotes, including them; empty if the line includes nothing.
std::string includeOf(const std::string& line) {
  static const std::regex include("\\s*#\\s*include\\s*(<[^>]*>|\"[^\"]*\"|\\S+).*");
  std::smatch match;
  return std::regex_match(line, match, include) ? match[1].str() : "";
}

bool mayUseLaboratory(const std::string& room, const std::string& header) {
  return kLaboratory.count(bigRoomOf(room)) || kLaboratoryUsers.count(room) ||
         std::pair(room, header) == kLaboratorySettings;
}

bool mayIncludeOwn(const std::string& room, const std::string& header) {
  const std::string target = roomOfHeader(header);
  if (kLaboratory.count(bigRoomOf(target)) && !mayUseLaboratory(room, header)) return false;
  const auto has = [](const auto& map, const std::string& key, const std::string& value) {
    const auto found = map.find(key);
    return found != map.end() && found->second.count(value) > 0;
  };
  if (has(kStrangers, bigRoomOf(room), bigRoomOf(target)) || has(kStrangerRooms, room, target))
    return false;
  if (room.rfind(target + '/', 0) == 0)  // the surrounding room
    return has(kSharedHeaders, target, fs::path(header).filename().string());
  return placeOf(target) <= placeOf(room);
}

bool mayIncludeForeign(const std::string& room, const std::string& header) {
  const std::string big = bigRoomOf(room);
  const bool standard = header.find_first_of("./") == std::string::npos;
  if (big == "core") {
    return standard || header.rfind("Eigen/", 0) == 0 || header.rfind("hwy/", 0) == 0 ||
           header.rfind("ceres/", 0) == 0 || header == "nanoflann.hpp";
  }
  const bool mrpt = header.rfind("mrpt/", 0) == 0;
  if (big == "config") return !mrpt || header.rfind("mrpt/config/", 0) == 0;
  return !((big == "io" || big == "sim") && mrpt);
}

bool exists(const std::string& header) {
  const fs::path file(header);
  for (const std::string base : {"libpolemcl/src", "libpolemcl/include", "apps"}) {
    if (fs::exists(kTop / base / file)) return true;
    if (fs::exists(kTop / base / (header + ".in"))) return true;  // the build makes it
    // Rows of C++ that the build makes from a table of this name.
    const fs::path table = kTop / base / fs::path(file).replace_extension(".csv");
    if (file.extension() == ".inc" && fs::exists(table)) return true;
  }
  return false;
}

/// Reason why a file may not include something; empty if it may. \param include With brackets or
/// quotes.
std::string whyNot(const fs::path& file, const std::string& include) {
  const std::string room = roomOf(file), header = include.substr(1, include.size() - 2);
  if (!isRoom(room)) return "the file is in no room";
  const bool quoted = include.front() == '"', ours = header.rfind("polemcl/", 0) == 0;
  if (!quoted && include.front() != '<') return "only plain includes can be checked";
  if (quoted && isPublic(file)) return "a public header includes public headers only";
  if (quoted && (ours || !exists(header))) return "quotes are for private headers, by their path";
  if (kAboveRooms.count(header)) return "";
  if (ours && !isRoom(fs::path(header.substr(8)).parent_path().generic_string()))
    return "sources include the header they need, not all";
  if (ours && !fs::exists(kTop / "libpolemcl/include" / header))
    return "there is no such public header";
  if (quoted || ours) return mayIncludeOwn(room, header) ? "" : "it stands below the room " + room;
  return mayIncludeForeign(room, header) ? "" : "the room " + room + " does not use that library";
}

std::vector<std::string> violations(const Source& source) {
  std::vector<std::string> found;
  for (std::size_t i = 0; i < source.lines.size(); ++i) {
    const std::string include = includeOf(source.lines[i]);
    if (include.empty()) continue;
    const std::string reason = whyNot(source.path, include);
    if (!reason.empty()) {
      found.push_back(source.path.string() + ":" + std::to_string(i + 1) + ": " + include + ": " +
                      reason);
    }
  }
  return found;
}

}  // namespace

TEST(Includes, RoomsIncludeOnlyWhatStandsAboveThem) {
  const std::vector<Source> sources = sourcesBelow({"libpolemcl", "apps"});
  std::size_t includes = 0;
  for (const Source& source : sources) {
    if (source.path.filename() == "CMakeLists.txt" || isAboveRooms(source.path)) continue;
    for (const std::string& violation : violations(source)) ADD_FAILURE() << violation;
    for (const std::string& line : source.lines) includes += !includeOf(line).empty();
  }
  EXPECT_GT(includes, 200u) << "the sources were not found";
}

TEST(Includes, OrderOfRoomsIsThatOfTheDocument) {
  std::vector<std::string> documented;
  static const std::regex row("\\| `([a-z_/]+)/` \\|.*");
  std::smatch match;
  for (const std::string& line : readLines(kTop / "share/doc/architecture.md")) {
    if (std::regex_match(line, match, row)) documented.push_back(match[1]);
  }
  EXPECT_EQ(documented, kOrder);
}

TEST(Includes, EverySourceIsInARoom) {
  for (const Source& source : sourcesBelow({"libpolemcl/src", "libpolemcl/include", "apps"})) {
    if (source.path.filename() == "CMakeLists.txt" || isAboveRooms(source.path)) continue;
    EXPECT_TRUE(isRoom(roomOf(source.path))) << source.path;
  }
}

/// `<polemcl/core.h>` has all of the room core, `<polemcl/polemcl.h>` that and all else.
TEST(Includes, HeadersForUsersIncludeAllPublicHeaders) {
  std::set<std::string> included, expected{"<polemcl/core.h>", "<polemcl/version.h>"};
  for (const std::string& name : kAllTogether) {
    for (const std::string& line : readLines(kTop / "libpolemcl/include/polemcl" / name)) {
      const std::string include = includeOf(line);
      if (include.empty()) continue;
      included.insert(include);
      if (name == "core.h" && include != "<polemcl/version.h>") {
        EXPECT_EQ(include.rfind("<polemcl/core/", 0), 0u) << include;
      }
    }
  }
  for (const Source& source : sourcesBelow({"libpolemcl/include"}))
    if (!isAboveRooms(source.path))
      expected.insert("<" + fs::relative(source.path, "libpolemcl/include").string() + ">");
  EXPECT_EQ(included, expected);
}

TEST(Includes, WrongIncludesAreFound) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"libpolemcl/src/core/common/A.cpp", "#include \"io/file/AtomicFile.h\""},
      {"libpolemcl/src/core/common/A.cpp", "#include \"core/sensor/SensorModel.h\""},
      {"libpolemcl/src/core/common/A.cpp", "  #  include <mrpt/poses/CPose2D.h>  // why not"},
      {"libpolemcl/src/core/common/A.cpp", "#include <zlib.h>"},
      {"libpolemcl/src/core/common/A.cpp", "#include \"../common/Types.h\""},
      {"libpolemcl/src/core/common/A.cpp", "#include \"Types.h\""},
      {"libpolemcl/src/core/common/A.cpp", "#include SOMETHING"},
      {"libpolemcl/src/core/extraction/scan_line/A.cpp",
       "#include \"core/extraction/range_image/CircleFit.h\""},
      {"libpolemcl/src/core/extraction/scan_line/A.cpp",
       "#include <polemcl/core/extraction/PoleExtractor.h>"},
      {"libpolemcl/src/io/file/A.cpp", "#include <mrpt/poses/CPose2D.h>"},
      {"libpolemcl/src/config/A.cpp", "#include <mrpt/poses/CPose2D.h>"},
      {"libpolemcl/src/mrpt/map/A.cpp", "#include \"sim/world/World.h\""},
      {"libpolemcl/src/sim/world/A.cpp", "#include <polemcl/mrpt/map/CPoleMap.h>"},
      {"libpolemcl/src/sim/world/A.cpp", "#include <mrpt/poses/CPose2D.h>"},
      {"libpolemcl/src/report/scene/A.cpp", "#include \"cli/CommandLine.h\""},
      {"libpolemcl/src/report/scene/A.cpp", "#include \"sim/world/World.h\""},
      {"apps/localize/A.cpp", "#include \"sim/drive/Simulation.h\""},
      {"apps/cli/A.cpp", "#include \"sim/world/World.h\""},
      {"apps/map/A.cpp", "#include \"sim/common/SimulationOptions.h\""},
      {"libpolemcl/src/elsewhere/A.cpp", "#include <vector>"},
      {"libpolemcl/include/polemcl/core/sensor/A.h", "#include \"core/common/KdTree2D.h\""},
      {"libpolemcl/include/polemcl/mrpt/map/A.h", "#include <polemcl/core/common/KdTree2D.h>"},
      {"libpolemcl/src/mrpt/map/A.cpp", "#include <polemcl/polemcl.h>"},
      {"apps/cli/A.cpp", "#include \"map/MapApp.h\""},
  };
  for (const auto& [path, line] : wrong)
    EXPECT_EQ(violations({path, {"", line}}).size(), 1u) << path << ' ' << line;
}

TEST(Includes, RightIncludesAreLeftAlone) {
  const std::vector<std::pair<std::string, std::string>> right{
      {"libpolemcl/src/core/sensor/A.cpp", "#include <polemcl/core/common/Types.h>"},
      {"libpolemcl/src/core/extraction/A.cpp",
       "#include \"core/extraction/scan_line/ScanLines.h\""},
      {"libpolemcl/src/core/extraction/scan_line/A.cpp",
       "#include <polemcl/core/extraction/ExtractionOptions.h>"},
      {"libpolemcl/src/core/common/A.cpp", "#include <Eigen/Dense>"},
      {"libpolemcl/src/core/common/A.cpp", "#include <nanoflann.hpp>"},
      {"libpolemcl/src/core/common/A.cpp", "// #include <mrpt/poses/CPose2D.h>"},
      {"libpolemcl/src/io/file/A.cpp", "#include <zlib.h>"},
      {"libpolemcl/src/config/A.cpp", "#include <mrpt/config/CConfigFileBase.h>"},
      {"libpolemcl/src/mrpt/map/A.cpp", "#include \"io/file/AtomicFile.h\""},
      {"libpolemcl/src/sim/common/A.cpp", "#include \"config/Config.h\""},
      {"apps/eval/A.cpp", "#include \"sim/world/World.h\""},
      {"apps/cli/A.cpp", "#include \"sim/common/SimulationOptions.h\""},
      {"apps/map/A.cpp", "#include \"map/MapApp.h\""},
      {"libpolemcl/include/polemcl/core/common/A.h", "#include <polemcl/export.h>"},
  };
  for (const auto& [path, line] : right)
    EXPECT_TRUE(violations({path, {line}}).empty()) << path << ' ' << line;
}

TEST(Includes, NoSourceIsLongerThanFiveHundredLines) {
  const std::vector<Source> sources =
      sourcesBelow({"libpolemcl", "apps", "tests", "share", "config"});
  ASSERT_FALSE(sources.empty());
  for (const Source& source : sources) EXPECT_LE(source.lines.size(), kMostLines) << source.path;
}

TEST(Includes, HeadersEndInHAndAreReadOnce) {
  static const std::set<std::string> otherSuffixes{".hh", ".hpp", ".hxx", ".inl", ".ipp"};
  for (const Source& source : sourcesBelow({"libpolemcl", "apps", "tests"})) {
    EXPECT_EQ(otherSuffixes.count(source.path.extension().string()), 0u) << source.path;
    if (source.path.extension() != ".h") continue;
    const bool once =
        std::find(source.lines.begin(), source.lines.end(), "#pragma once") != source.lines.end();
    EXPECT_TRUE(once) << source.path;
  }
}

}  // namespace polemcl::test_includes
