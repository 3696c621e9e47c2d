/// \file test_PlainEnglish.cpp
/// \brief Reads comments, configuration files and documents, and rejects phrases that readers
/// whose first language is not English stumble over.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace polemcl::test_plain_english {

namespace fs = std::filesystem;

namespace {

const fs::path s_top = POLEMCL_SOURCE_DIR;

/// Whole words; upper and lower case are the same, and a phrase may go on in the next line.
const std::vector<std::string> s_phrases{"so many",           "by so much", "is none",
                                         "likewise",          "borne out",  "all the same",
                                         "of no consequence", "as it were"};

using Lines = std::vector<std::string>;

/// One piece of text for people.
struct Prose {
  std::size_t line = 0;  ///< in its file, from 1
  std::string text;
  bool wholeLine = false;  ///< no code stands in the line, so it may continue the line before
};

Lines readLines(const fs::path& path) {
  std::ifstream file(path);
  Lines lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

bool isBlank(const std::string& text) {
  return text.find_first_not_of(" \t") == std::string::npos;
}

/// Code in backquotes is no English: a mark takes its place, so that its neighbours do not meet.
std::string withoutCode(const std::string& text) {
  std::string plain;
  std::size_t i = 0;
  while (i < text.size()) {
    const std::size_t end = text[i] == '`' ? text.find('`', i + 1) : std::string::npos;
    plain += text[i];
    i = end == std::string::npos ? i + 1 : end + 1;
  }
  return plain;
}

/// Where the C++ scanner stands between two lines.
struct CppState {
  bool inBlock = false;    ///< inside a block comment
  std::string rawLiteral;  ///< what ends the raw string literal that is open; empty without one
};

/// End of a string or character literal, behind its closing quote.
std::size_t endOfLiteral(const std::string& line, std::size_t begin) {
  std::size_t i = begin + 1;
  while (i < line.size() && line[i] != line[begin]) i += line[i] == '\\' ? 2 : 1;
  return std::min(i + 1, line.size());
}

bool isWordCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

/// Skips the literal that begins at a quote. \return Where the code goes on.
std::size_t skipLiteral(const std::string& line, std::size_t quote, CppState& state) {
  const char before = quote > 0 ? line[quote - 1] : ' ';
  if (line[quote] == '\'' && isWordCharacter(before)) return quote + 1;  // 1'000
  if (line[quote] != '"' || before != 'R') return endOfLiteral(line, quote);
  const std::size_t open = std::min(line.find('(', quote), line.size());
  const std::string end = ")" + line.substr(quote + 1, open - quote - 1) + "\"";
  const std::size_t close = line.find(end, open);
  if (close != std::string::npos) return close + end.size();
  state.rawLiteral = end;
  return line.size();
}

/// Comment text of one line of C++, and where it begins; the size of the line without one.
std::size_t findComment(const std::string& line, CppState& state, std::string& comment) {
  std::size_t i = 0, begin = line.size();
  while (i < line.size()) {
    if (!state.rawLiteral.empty()) {
      const std::size_t end = line.find(state.rawLiteral);
      if (end == std::string::npos) break;
      i = end + state.rawLiteral.size();
      state.rawLiteral.clear();
    } else if (state.inBlock || line.compare(i, 2, "/*") == 0) {
      begin = std::min(begin, i);
      const std::size_t end = line.find("*/", state.inBlock ? i : i + 2);
      state.inBlock = end == std::string::npos;
      comment += line.substr(i, end - i) + ' ';
      i = state.inBlock ? line.size() : end + 2;
    } else if (line.compare(i, 2, "//") == 0) {
      comment += line.substr(i);
      return std::min(begin, i);
    } else {
      i = line[i] == '"' || line[i] == '\'' ? skipLiteral(line, i, state) : i + 1;
    }
  }
  return begin;
}

std::vector<Prose> proseOfCpp(const Lines& lines) {
  std::vector<Prose> prose;
  CppState state;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::string comment;
    const std::size_t begin = findComment(lines[i], state, comment);
    const std::size_t text = comment.find_first_not_of("/*!< ");
    if (begin < lines[i].size()) {
      prose.push_back({i + 1, text == std::string::npos ? "" : comment.substr(text),
                       isBlank(lines[i].substr(0, begin))});
    }
  }
  return prose;
}

/// Where a comment begins that is marked by one of these characters, at the start of the line or
/// behind a space; the size of the line without one.
std::size_t findMark(const std::string& line, const std::string& marks) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    const std::size_t text = std::min(line.find_first_not_of(marks, i), line.size());
    const bool apart = (i == 0 || line[i - 1] == ' ') && (text == line.size() || line[text] == ' ');
    if (text > i && apart) return i;
  }
  return line.size();
}

std::vector<Prose> proseBehind(const std::string& marks, const Lines& lines) {
  std::vector<Prose> prose;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t begin = findMark(lines[i], marks);
    if (begin == lines[i].size()) continue;
    const std::size_t text = std::min(lines[i].find_first_not_of(marks, begin), lines[i].size());
    prose.push_back({i + 1, lines[i].substr(text), isBlank(lines[i].substr(0, begin))});
  }
  return prose;
}

std::vector<Prose> proseOfMarkdown(const Lines& lines) {
  std::vector<Prose> prose;
  bool inCode = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t text = lines[i].find_first_not_of(' ');
    const bool atFence = text != std::string::npos && lines[i].compare(text, 3, "```") == 0;
    if (atFence) inCode = !inCode;
    if (!atFence && !inCode) prose.push_back({i + 1, lines[i], true});
  }
  return prose;
}

std::vector<Prose> proseOf(const fs::path& path, const Lines& lines) {
  const std::string ending = path.extension().string();
  if (ending == ".md") return proseOfMarkdown(lines);
  if (ending == ".ini") return proseBehind(";#", lines);
  if (ending == ".h" || ending == ".cpp" || ending == ".inc") return proseOfCpp(lines);
  return proseBehind("#", lines);
}

/// Text of neighbouring lines, joined, with the place in the text where each line begins.
struct Passage {
  std::string text;
  std::vector<std::pair<std::size_t, std::size_t>> starts;  ///< place in the text, number of line

  void append(const Prose& prose) {
    if (!text.empty()) text += ' ';
    starts.emplace_back(text.size(), prose.line);
    text += prose.text;
  }
  std::size_t lineOf(std::size_t place) const {
    std::size_t line = starts.front().second;
    for (const auto& [start, number] : starts)
      if (start <= place) line = number;
    return line;
  }
};

std::vector<Passage> passagesOf(const std::vector<Prose>& prose) {
  std::vector<Passage> passages;
  const Prose* before = nullptr;
  for (const Prose& piece : prose) {
    const bool continues = before != nullptr && piece.wholeLine && before->line + 1 == piece.line &&
                           !isBlank(piece.text);
    if (!continues) passages.emplace_back();
    passages.back().append(piece);
    before = &piece;
  }
  return passages;
}

/// The phrases as one expression.
const std::regex& hardWords() {
  static const std::regex expression = [] {
    std::string all;
    for (const std::string& phrase : s_phrases)
      all += (all.empty() ? "" : "|") + std::regex_replace(phrase, std::regex(" "), "\\s+");
    return std::regex("\\b(" + all + ")\\b", std::regex::icase);
  }();
  return expression;
}

void findIn(const Passage& passage, const std::regex& expression, const std::string& file,
            std::set<std::pair<std::size_t, std::string>>& found) {
  const std::sregex_iterator end;
  for (std::sregex_iterator it(passage.text.begin(), passage.text.end(), expression); it != end;
       ++it) {
    const std::size_t line = passage.lineOf(it->position());
    found.emplace(line, file + ":" + std::to_string(line) + ": \"" + it->str() + "\"");
  }
}

/// Each hard phrase of a file as "file:line: phrase", in the order of the lines.
Lines findings(const fs::path& path, const Lines& lines) {
  static const std::regex ofFirst("\\bOf(?=\\s)");  // with a capital it begins a sentence
  std::vector<Prose> prose = proseOf(path, lines);
  for (Prose& piece : prose) piece.text = withoutCode(piece.text);
  std::set<std::pair<std::size_t, std::string>> found;
  for (const Passage& passage : passagesOf(prose)) {
    findIn(passage, hardWords(), path.generic_string(), found);
    findIn(passage, ofFirst, path.generic_string(), found);
  }
  Lines reports;
  for (const auto& [line, report] : found) reports.push_back(report);
  return reports;
}

/// Files below a folder (or the file itself) with one of the endings, by name.
std::vector<fs::path> filesBelow(const std::string& place, const std::set<std::string>& endings) {
  if (fs::is_regular_file(s_top / place)) return {place};
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(s_top / place)) {
    const fs::path path = fs::relative(entry.path(), s_top);
    // share/demo/out is written by the demo.
    const bool wanted = endings.count(path.extension().string()) > 0 &&
                        path.generic_string().rfind("share/demo/out", 0) != 0;
    if (entry.is_regular_file() && wanted) files.push_back(path);
  }
  std::sort(files.begin(), files.end());
  return files;
}

void expectPlain(const std::vector<std::string>& places, const std::set<std::string>& endings,
                 std::size_t leastFiles) {
  std::size_t read = 0;
  for (const std::string& place : places) {
    for (const fs::path& path : filesBelow(place, endings)) {
      ++read;
      for (const std::string& finding : findings(path, readLines(s_top / path)))
        ADD_FAILURE() << finding << ": say it in plain words";
    }
  }
  EXPECT_GE(read, leastFiles) << "the files were not found";
}

}  // namespace

TEST(PlainEnglish, CommentsOfSources) {
  expectPlain({"libpolemcl", "apps", "tests"}, {".h", ".cpp", ".inc", ".in", ".sh", ".txt", ".py"},
              200);
}

TEST(PlainEnglish, CommentsOfScripts) {
  expectPlain({"share"}, {".sh", ".cmake", ".yml"}, 15);
}

TEST(PlainEnglish, CommentsOfConfigurations) {
  expectPlain({"config"}, {".ini"}, 10);
}

TEST(PlainEnglish, Documents) {
  expectPlain({"README.md", "CONTRIBUTING.md", "CHANGELOG.md", "share/doc", "share/figures"},
              {".md"}, 10);
}

TEST(PlainEnglish, HardPhrasesAreFoundWithFileAndLine) {
  const std::vector<std::pair<std::string, Lines>> wrong{
      {"a/A.md:1: \"so many\"", {"It needs so many poles."}},
      {"a/A.md:1: \"by so much\"", {"The map is off by so much."}},
      {"a/A.md:1: \"is none\"", {"There is none."}},
      {"a/A.md:1: \"Likewise\"", {"Likewise for maps."}},
      {"a/A.md:1: \"borne out\"", {"The pose is not borne out."}},
      {"a/A.md:1: \"all the same\"", {"It is taken all the same."}},
      {"a/A.md:1: \"of no consequence\"", {"That is of no consequence."}},
      {"a/A.md:1: \"as it were\"", {"It sees, as it were, the pole."}},
      {"a/A.md:2: \"Of\"", {"First.", "A run stays. Of a run stay the poses."}},
      {"a/A.md:4: \"Of\"", {"```", "Of code", "```", "- Of a run stay the poses."}},
      {"a/A.md:1: \"so many\"", {"Poles, so", "many of them."}},
      {"a/A.h:2: \"so many\"", {"int a = 1;", "  /// Scans of so many metres."}},
      {"a/A.h:1: \"Of\"", {"int a = 1;  ///< Of the points, those in front"}},
      {"a/A.h:1: \"borne out\"", {"/// A pose that was not borne", "/// out by poles."}},
      {"a/A.h:1: \"so many\"", {"int a = 1;  ///< seen in so", "            ///< many scans"}},
      {"a/A.cpp:2: \"likewise\"", {"/* Widened", " * likewise. */"}},
      {"a/A.cpp:1: \"likewise\"", {"const char* url = \"http://a\";  // likewise"}},
      {"a/A.cpp:1: \"likewise\"", {"int a = 1'000;  // likewise"}},
      {"a/A.cpp:1: \"likewise\"", {"int a = /* likewise */ 3;"}},
      {"a/A.cpp:3: \"likewise\"", {"auto a = R\"(text", "// text)\";", "// likewise"}},
      {"a/A.ini:2: \"so many\"", {"[map]", "min_count = 3  ; so many sections"}},
      {"a/A.ini:1: \"Of\"", {"; Of the poles, the share that is seen"}},
      {"a/a.sh:1: \"so many\"", {"# Draws so many poles."}},
      {"a/CMakeLists.txt:1: \"is none\"", {"set(a b) # if there is none"}},
  };
  for (const auto& [report, lines] : wrong)
    EXPECT_EQ(findings(report.substr(0, report.find(':')), lines), Lines{report}) << lines.front();
}

TEST(PlainEnglish, EachFindingIsReportedInTheOrderOfTheLines) {
  const Lines expected{"A.md:1: \"Of\"", "A.md:2: \"so many\"", "A.md:3: \"so many\""};
  EXPECT_EQ(findings("A.md", {"Of them,", "so many are far,", "so many are near."}), expected);
}

TEST(PlainEnglish, PlainTextIsLeftAlone) {
  const std::vector<std::pair<std::string, Lines>> right{
      {"A.md", {"The poles of the map. One of them; off, offset, Office."}},
      {"A.md", {"The reason is `none`; `Of` and `so many` are code."}},
      {"A.md", {"```", "likewise", "```", "Plain."}},
      {"A.md", {"Poles, so", "", "many of them."}},
      {"A.h", {"/// Number of poles.", "int soMany;  ///< none of them is lost"}},
      {"A.h", {"int a;  ///< as it", "int b;  ///< were read"}},
      {"A.cpp", {"const char* a = \"likewise // likewise\";", "char b = '\"';  // plain"}},
      {"A.cpp", {"const char* a = \"b \\\" // likewise\";"}},
      {"A.cpp", {"const char* a = R\"x(", "// likewise", ")x\";  // plain"}},
      {"A.cpp", {"/* plain */ int likewise = 1;"}},
      {"A.ini", {"title = all the same  ; plain", "[so many]"}},
      {"a.sh", {"echo likewise # plain", "printf '%s' \"${likewise#a}\""}},
  };
  for (const auto& [file, lines] : right)
    EXPECT_EQ(findings(file, lines), Lines{}) << lines.front();
}

}  // namespace polemcl::test_plain_english
