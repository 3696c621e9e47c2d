// What `--help` says of every program and subcommand, and that its examples can be typed.

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "batch/BatchApp.h"
#include "cli/CommandLine.h"
#include "cli/HelpFormatter.h"
#include "cli/Version.h"
#include "eval/EvalApp.h"
#include "extract/ExtractApp.h"
#include "import/ImportApp.h"
#include "labels/LabelsApp.h"
#include "localize/LocalizeApp.h"
#include "map/MapApp.h"
#include "simulate/SimulateApp.h"
#include "support/Shell.h"

namespace polemcl::test_help_texts {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

using Words = std::vector<std::string>;

const std::map<std::string, int (*)(int, const char* const*)> kPrograms{
    {"pole-import", importMain},     {"pole-extract", extractMain}, {"pole-map", mapMain},
    {"pole-localize", localizeMain}, {"pole-eval", evalMain},       {"pole-simulate", simulateMain},
    {"pole-batch", batchMain},       {"pole-labels", labelsMain}};

/// The words of a command; quotes hold words together.
Words typed(const std::string& command) {
  Words words;
  const std::regex word("'([^']*)'|(\\S+)");
  for (std::sregex_iterator it(command.begin(), command.end(), word), end; it != end; ++it)
    words.push_back((*it)[1].matched ? (*it)[1] : (*it)[2]);
  return words;
}

Outcome run(const std::string& command) {
  const Words words = typed(command);
  return runProgram(kPrograms.at(words.front()), {words.begin() + 1, words.end()});
}

/// The lines of a section; a line that goes on belongs to the one above.
Words section(const std::string& help, const std::string& title) {
  Words entries;
  const std::size_t at = help.find("\n" + title + ":\n");
  std::istringstream lines(at == help.npos ? "" : help.substr(at + title.size() + 3));
  for (std::string line; std::getline(lines, line) && !line.empty();)
    if (line.rfind("   ", 0) != 0)
      entries.push_back(line.substr(2));
    else
      entries.back() += "  " + line.substr(line.find_first_not_of(' '));
  return entries;
}

std::string firstWord(const std::string& text) {
  return text.substr(0, text.find(' '));
}

/// Every program and subcommand, with its help.
const std::map<std::string, std::string>& helps() {
  static const auto all = [] {
    std::map<std::string, std::string> texts;
    for (const auto& [name, main] : kPrograms) {
      texts[name] = run(name + " --help").out;
      for (const std::string& entry : section(texts[name], "Subcommands")) {
        const std::string command = name + ' ' + firstWord(entry);
        texts[command] = run(command + " --help").out;
      }
    }
    return texts;
  }();
  return all;
}

TEST(HelpTexts, ProgramsAnswerInTheirNames) {
  for (const auto& [name, main] : kPrograms) {
    const Outcome version = shell(std::string(POLEMCL_BIN_DIR) + "/" + name + " --version");
    EXPECT_EQ(version.out, versionLine(name) + "\n");
    EXPECT_EQ(version.code, 0);
  }
}

TEST(HelpTexts, EveryCommandHasExamplesThatParse) {
  EXPECT_GT(helps().size(), 25u);
  const TempFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());  // where no input is: work fails with 1, parsing with 2
  for (const auto& [name, help] : helps()) {
    const Words examples = section(help, "Examples");
    EXPECT_FALSE(examples.empty()) << name;
    EXPECT_HAS(help, "\nNext:\n  ");
    for (const std::string& example : examples) {
      EXPECT_EQ(example.rfind(name + " ", 0), 0u) << example << " is no example of " << name;
      const bool takesSettings = example.find("--config ") != example.npos || name == "pole-batch";
      const Outcome tried = run(example + (takesSettings ? " --set no.setting=1" : ""));
      EXPECT_EQ(tried.code, 1) << example << '\n' << tried.err;
    }
  }
  EXPECT_EQ(run("pole-map build --confg demo.ini").code, 2);
  fs::current_path(before);
}

TEST(HelpTexts, WhatToDoNextNamesOptionsThatExist) {
  const std::regex command("pole-[a-z]+ (?:[^.:;,]|\\.[a-z])+");
  std::size_t found = 0;
  for (const auto& [name, help] : helps()) {
    std::string next;
    for (const std::string& line : section(help, "Next")) next += ' ' + line;
    for (std::sregex_iterator it(next.begin(), next.end(), command), end; it != end; ++it) {
      const Words words = typed(it->str());
      const auto below = helps().find(words[0] + ' ' + words[1]);
      const std::string& known = below == helps().end() ? helps().at(words[0]) : below->second;
      for (const std::string& word : words) {
        if (word.rfind("--", 0) == 0) {
          EXPECT_HAS(known, ' ' + word) << name << ": " << it->str();
        }
      }
      ++found;
    }
  }
  EXPECT_GT(found, 15u);
}

TEST(HelpTexts, NumbersHaveUnitsAndDefaults) {
  const std::regex unit("\\b(m|s|deg|share|multiple|factor)\\b");
  const std::regex number("\\S+ (NUMBER|N|K|\\S+\\|\\S+)  .*");  // or one of some words
  std::size_t numbers = 0;
  for (const auto& [name, help] : helps())
    for (const std::string& option : section(help, "Options")) {
      std::smatch match;
      if (!std::regex_match(option, match, number)) continue;
      ++numbers;
      const std::string meaning = option.substr(0, option.rfind(" ("));
      EXPECT_TRUE(match[1] != "NUMBER" || std::regex_search(meaning, unit)) << name << option;
      EXPECT_TRUE(option.find("(required") != option.npos ||
                  option.find("default: ") != option.npos)
          << name << ": " << option;
    }
  EXPECT_GT(numbers, 30u);
}

TEST(HelpTexts, HoldNoNumbersOfWordsAndNoLongLines) {
  for (const auto& [name, help] : helps()) {
    EXPECT_EQ(help.find("->"), std::string::npos) << help;
    EXPECT_EQ(help.find('{'), help.find("{data}")) << help;  // of pole-batch
    EXPECT_HAS(help, "\nUsage: " + name + " ");
    std::istringstream lines(help.substr(0, help.find("\nExamples:")));
    // A list of words, as of --sensor, is not broken: it can be copied.
    const std::regex wordList("  --[a-z]+ [a-z0-9_|-]+");
    for (std::string line; std::getline(lines, line);)
      EXPECT_TRUE(line.size() <= 80 || line.rfind("Usage:", 0) == 0 ||
                  std::regex_match(line, wordList))
          << name << ": " << line;
  }
}

TEST(HelpTexts, TellHowOptionsGoTogether) {
  CLI::App app("Tries things.", "pole-test");
  app.formatter(std::make_shared<HelpFormatter>());
  double radius = 0.5;
  int count = 3, value = 0;
  std::vector<std::string> files;
  auto* one = addNumber(app, "-r,--radius", radius, "Distance, m", CLI::PositiveNumber);
  app.add_flag("--whole", "All")->excludes(one);
  addNumber(app, "--count", count, "Number", CLI::Range(1, 9))->needs(one);
  addChoice<int>(app, "--kind", value, {{"first", 1}, {"second", 2}}, "Kind")->required();
  addFile(app, "inputs", files, "Files to read")->required();
  EXPECT_EQ(app.help(), R"(Tries things.

Usage: pole-test --kind first|second inputs [OPTIONS]

Arguments:
  inputs FILE...          Files to read (required)

Options:
  -h, --help              Print this help message and exit
  -r, --radius NUMBER     Distance, m (above 0; default: 0.5; not with --whole)
  --whole                 All (not with --radius)
  --count N               Number (1 to 9; default: 3; needs --radius)
  --kind first|second     Kind (required)
)");
  app.parse("--kind second in.rawlog", false);
  EXPECT_EQ(value, 2);
  EXPECT_THROW(app.parse("--kind 1 in.rawlog", false), CLI::ValidationError);
}

}  // namespace
}  // namespace polemcl::test_help_texts
