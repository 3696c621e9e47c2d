/// \file test_Includes.cpp
/// \brief Reads every source of the library and the programs, and holds the house rules of
/// share/doc/architecture.md: rooms look upwards only, files and mains stay small.

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

namespace fs = std::filesystem;

namespace {

const fs::path s_top = POLEMCL_SOURCE_DIR;

constexpr std::size_t s_mostLines = 500;
constexpr std::size_t s_mostLinesOfAMain = 60;

/// Rooms in the order of the document, each with the rooms whose headers it may include.
struct Room {
  std::string name;
  std::set<std::string> knows;
};
const std::vector<Room> s_rooms{
    {"core", {"core"}},
    {"io", {"core", "io"}},
    {"mrpt", {"core", "io", "mrpt"}},
    {"sim", {"core", "io", "sim"}},
    {"report", {"core", "io", "mrpt", "sim", "report"}},
    {"apps", {"core", "io", "mrpt", "sim", "report", "apps"}},
};

/// Single headers that a room may include beyond the rooms it knows.
const std::map<std::string, std::set<std::string>> s_exceptions{{"sim", {"polemcl/mrpt/Config.h"}}};

struct Source {
  fs::path path;  ///< relative to the top
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
    if (!fs::exists(s_top / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(s_top / folder)) {
      // share/demo/out is what the demo wrote, no source.
      const fs::path path = fs::relative(entry.path(), s_top);
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

bool isRoom(const std::string& name) {
  return std::any_of(s_rooms.begin(), s_rooms.end(), [&](const Room& r) { return r.name == name; });
}

/// The room a file belongs to; "programs" for apps/<program>, empty for what is in no room.
std::string roomOf(const fs::path& path) {
  static const std::regex library("libpolemcl/(include/polemcl|src)/([a-z]+)/[^/]+"),
      program("apps/[^/]+/[^/]+");
  std::smatch match;
  const std::string text = path.generic_string();
  if (std::regex_match(text, match, library)) return match[2];
  if (std::regex_match(text, program)) return "programs";
  return "";
}

/// What stands between the brackets or quotes, with them; empty if the line includes nothing.
std::string includeOf(const std::string& line) {
  static const std::regex include("\\s*#\\s*include\\s*(<[^>]*>|\"[^\"]*\"|\\S+).*");
  std::smatch match;
  return std::regex_match(line, match, include) ? match[1].str() : "";
}

bool mayIncludeOwn(const std::string& room, const std::string& header) {
  const std::string target = header.substr(8, header.find('/', 8) - 8);  // polemcl/<target>/File.h
  if (room == "programs") return target == "apps";
  const auto exception = s_exceptions.find(room);
  if (exception != s_exceptions.end() && exception->second.count(header) > 0) return true;
  return std::any_of(s_rooms.begin(), s_rooms.end(),
                     [&](const Room& r) { return r.name == room && r.knows.count(target) > 0; });
}

bool mayIncludeForeign(const std::string& room, const std::string& header) {
  if (room == "programs") return false;
  const bool standard = header.find_first_of("./") == std::string::npos;
  if (room == "core") {
    return standard || header.rfind("Eigen/", 0) == 0 || header.rfind("hwy/", 0) == 0 ||
           header == "nanoflann.hpp";
  }
  return !((room == "io" || room == "sim") && header.rfind("mrpt/", 0) == 0);
}

/// Why a file may not include something; empty if it may. \param include With brackets or quotes.
std::string whyNot(const fs::path& file, const std::string& include) {
  const std::string room = roomOf(file), header = include.substr(1, include.size() - 2);
  if (!isRoom(room) && room != "programs") return "the file is in no room";
  if (include.front() == '"') {
    return fs::exists(s_top / file.parent_path() / header)
               ? ""
               : "quotes are for headers beside the file";
  }
  if (include.front() != '<') return "only plain includes can be checked";
  if (header.rfind("polemcl/", 0) == 0) {
    return mayIncludeOwn(room, header) ? "" : "the room " + room + " does not know that one";
  }
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

TEST(Includes, roomsLookUpwardsOnly) {
  const std::vector<Source> sources = sourcesBelow({"libpolemcl", "apps"});
  std::size_t includes = 0;
  for (const Source& source : sources) {
    if (source.path.filename() == "CMakeLists.txt") continue;
    for (const std::string& violation : violations(source)) ADD_FAILURE() << violation;
    for (const std::string& line : source.lines) includes += !includeOf(line).empty();
  }
  EXPECT_GT(includes, 200u) << "the sources were not found";
}

TEST(Includes, theOrderOfRoomsIsTheDocuments) {
  std::vector<std::string> documented, known;
  static const std::regex row("\\| `([a-z]+)/` \\|.*");
  std::smatch match;
  for (const std::string& line : readLines(s_top / "share/doc/architecture.md")) {
    if (std::regex_match(line, match, row)) documented.push_back(match[1]);
  }
  for (const Room& room : s_rooms) known.push_back(room.name);
  EXPECT_EQ(documented, known);
  // A room knows itself and rooms above it only.
  for (auto room = s_rooms.begin(); room != s_rooms.end(); ++room) {
    for (const std::string& other : room->knows) {
      EXPECT_TRUE(
          std::any_of(s_rooms.begin(), room + 1, [&](const Room& r) { return r.name == other; }));
    }
  }
}

TEST(Includes, everySourceOfTheLibraryIsInARoom) {
  for (const Source& source : sourcesBelow({"libpolemcl/include", "libpolemcl/src"})) {
    EXPECT_TRUE(isRoom(roomOf(source.path))) << source.path;
  }
}

TEST(Includes, wrongIncludesAreFound) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"libpolemcl/src/core/A.cpp", "#include <polemcl/io/AtomicFile.h>"},
      {"libpolemcl/include/polemcl/core/A.h", "#include <polemcl/mrpt/Config.h>"},
      {"libpolemcl/src/core/A.cpp", "  #  include <mrpt/poses/CPose2D.h>  // why not"},
      {"libpolemcl/src/core/A.cpp", "#include <zlib.h>"},
      {"libpolemcl/src/core/A.cpp", "#include \"../io/AtomicFile.h\""},
      {"libpolemcl/src/core/A.cpp", "#include SOMETHING"},
      {"libpolemcl/src/io/A.cpp", "#include <mrpt/poses/CPose2D.h>"},
      {"libpolemcl/src/mrpt/A.cpp", "#include <polemcl/sim/World.h>"},
      {"libpolemcl/src/sim/A.cpp", "#include <polemcl/mrpt/CPoleMap.h>"},
      {"libpolemcl/src/sim/A.cpp", "#include <mrpt/poses/CPose2D.h>"},
      {"libpolemcl/src/report/A.cpp", "#include <polemcl/apps/CommandLine.h>"},
      {"libpolemcl/src/elsewhere/A.cpp", "#include <vector>"},
      {"apps/pole-map/main.cpp", "#include <polemcl/core/Types.h>"},
      {"apps/pole-map/main.cpp", "#include <CLI/CLI.hpp>"},
  };
  for (const auto& [path, line] : wrong)
    EXPECT_EQ(violations({path, {"", line}}).size(), 1u) << path << ' ' << line;
}

TEST(Includes, rightIncludesAreLeftAlone) {
  const std::vector<std::pair<std::string, std::string>> right{
      {"libpolemcl/src/core/A.cpp", "#include <polemcl/core/Types.h>"},
      {"libpolemcl/src/core/A.cpp", "#include <Eigen/Dense>"},
      {"libpolemcl/src/core/A.cpp", "#include <nanoflann.hpp>"},
      {"libpolemcl/src/core/A.cpp", "#include <hwy/highway.h>"},
      {"libpolemcl/src/core/A.cpp", "// #include <mrpt/poses/CPose2D.h>"},
      {"libpolemcl/src/io/A.cpp", "#include <zlib.h>"},
      {"libpolemcl/src/mrpt/A.cpp", "#include <polemcl/io/AtomicFile.h>"},
      {"libpolemcl/src/sim/A.cpp", "#include <polemcl/mrpt/Config.h>"},
      {"libpolemcl/src/report/A.cpp", "#include <polemcl/sim/World.h>"},
      {"apps/pole-map/main.cpp", "#include <polemcl/apps/CommandLine.h>"},
  };
  for (const auto& [path, line] : right)
    EXPECT_TRUE(violations({path, {line}}).empty()) << path << ' ' << line;
}

TEST(Includes, noSourceIsLongerThanFiveHundredLines) {
  const std::vector<Source> sources =
      sourcesBelow({"libpolemcl", "apps", "tests", "share", "config"});
  ASSERT_FALSE(sources.empty());
  for (const Source& source : sources) EXPECT_LE(source.lines.size(), s_mostLines) << source.path;
}

TEST(Includes, mainsAreShort) {
  for (const Source& source : sourcesBelow({"apps"})) {
    if (source.path.filename() == "main.cpp") {
      EXPECT_LE(source.lines.size(), s_mostLinesOfAMain) << source.path;
    }
  }
}

TEST(Includes, headersEndInHAndAreReadOnce) {
  static const std::set<std::string> otherSuffixes{".hh", ".hpp", ".hxx", ".inl", ".ipp"};
  for (const Source& source : sourcesBelow({"libpolemcl", "apps", "tests"})) {
    EXPECT_EQ(otherSuffixes.count(source.path.extension().string()), 0u) << source.path;
    if (source.path.extension() != ".h") continue;
    const bool once =
        std::find(source.lines.begin(), source.lines.end(), "#pragma once") != source.lines.end();
    EXPECT_TRUE(once) << source.path;
  }
}
