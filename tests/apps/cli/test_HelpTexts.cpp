/// \file test_HelpTexts.cpp
/// \brief What `--help` says of every program and subcommand, and that its examples can be typed.

#include <gtest/gtest.h>

#include <functional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cli/CommandLine.h"
#include "cli/Guides.h"
#include "cli/OptionText.h"
#include "cli/Programs.h"

namespace polemcl::test_help_texts {

using namespace polemcl::apps;

namespace {

using Visit = std::function<void(CLI::App& app, const std::string& name, const std::string& help)>;

/// Every program and every subcommand.
void forEachCommand(const Visit& visit) {
  for (const Program& program : programs())
    visitOptions(program.main, program.name, [&](CLI::App& cli) {
      visit(cli, program.name, cli.help());
      for (CLI::App* command : subcommandsOf(cli))
        visit(*command, program.name + (" " + command->get_name()), command->help(program.name));
    });
}

/// The words of a command; quotes hold words together.
std::vector<std::string> typed(const std::string& command) {
  std::vector<std::string> words;
  const std::regex word("'([^']*)'|(\\S+)");
  for (std::sregex_iterator it(command.begin(), command.end(), word), end; it != end; ++it)
    words.push_back((*it)[1].matched ? (*it)[1] : (*it)[2]);
  return words;
}

/// Parses a command as its program does, without its work. \return What is wrong.
std::string problemOfCommand(const std::string& command) {
  const std::vector<std::string> words = typed(command);
  std::string problem = "no such program";
  std::vector<const char*> argv;
  for (const std::string& each : words) argv.push_back(each.c_str());
  for (const Program& program : programs())
    if (words.front() == program.name)
      visitOptions(program.main, program.name, [&](CLI::App& cli) {
        try {
          cli.parse(static_cast<int>(argv.size()), argv.data());
          problem.clear();
        } catch (const CLI::ParseError& e) {
          problem = e.what();
        }
      });
  return problem;
}

}  // namespace

TEST(HelpTexts, EveryCommandHasExamplesThatParse) {
  std::set<std::string> names;
  forEachCommand([&](CLI::App&, const std::string& name, const std::string& help) {
    names.insert(name);
    const Guide& guide = guideOf(name);
    EXPECT_FALSE(guide.examples.empty()) << name;
    EXPECT_FALSE(guide.next.empty()) << name;
    EXPECT_NE(help.find("\nExamples:\n  " + name), std::string::npos) << help;
    EXPECT_NE(help.find("\nNext:\n  "), std::string::npos) << help;
  });
  EXPECT_EQ(names.size(), guides().size()) << "guides of commands that do not exist";
  for (const auto& [name, guide] : guides())
    for (const std::string& example : guide.examples) {
      EXPECT_EQ(problemOfCommand(example), "") << example;
      EXPECT_EQ(example.rfind(name + " ", 0), 0u) << example << " is no example of " << name;
    }
  EXPECT_NE(problemOfCommand("pole-map build --confg demo.ini"), "");
}

TEST(HelpTexts, WhatToDoNextNamesOptionsThatExist) {
  const std::regex command("pole-[a-z]+ (?:[^.:;,]|\\.[a-z])*");
  std::size_t found = 0;
  for (const auto& [name, guide] : guides())
    for (std::sregex_iterator it(guide.next.begin(), guide.next.end(), command), end; it != end;
         ++it)
      for (const Program& program : programs()) {
        const std::vector<std::string> words = typed(it->str());
        if (words.front() != program.name) continue;
        visitOptions(program.main, program.name, [&](CLI::App& cli) {
          CLI::App* app = &cli;
          for (CLI::App* sub : subcommandsOf(cli))
            if (words.size() > 1 && sub->get_name() == words[1]) app = sub;
          for (const std::string& word : words)
            EXPECT_TRUE(word.rfind("--", 0) != 0 || app->get_option_no_throw(word) ||
                        cli.get_option_no_throw(word))
                << name << ": " << it->str() << ": " << word;
        });
        ++found;
      }
  EXPECT_GT(found, 20u);
}

TEST(HelpTexts, NumbersHaveUnitsAndDefaults) {
  const std::regex unit("\\b(m|s|deg|share|multiple|factor)\\b");
  forEachCommand([&](CLI::App& app, const std::string& name, const std::string&) {
    for (const OptionText& option : optionsOf(app, false)) {
      const std::string what = name + " " + option.head() + ": " + option.meaning;
      const std::string meaning = option.meaning.substr(0, option.meaning.rfind(" ("));
      EXPECT_TRUE(option.value != "NUMBER" || std::regex_search(meaning, unit)) << what;
      const bool optional =
          !option.required && (option.value == "N" || option.value == "K" ||
                               option.value == "NUMBER" || !option.choices.empty());
      EXPECT_EQ(optional, optional && option.meaning.find("default: ") != std::string::npos)
          << what;
    }
  });
}

TEST(HelpTexts, HoldNoNumbersOfWordsAndNoLongLines) {
  forEachCommand([&](CLI::App&, const std::string& name, const std::string& help) {
    EXPECT_EQ(help.find("->"), std::string::npos) << help;
    EXPECT_EQ(help.find('{'), help.find("{data}")) << help;  // of pole-batch
    EXPECT_NE(help.find("Usage: " + name + " "), std::string::npos) << help;
    std::istringstream lines(help.substr(0, help.find("\nExamples:")));
    for (std::string line; std::getline(lines, line);)
      EXPECT_TRUE(line.size() <= 80 || line.rfind("Usage:", 0) == 0 ||
                  line.rfind("  --sensor ", 0) == 0)
          << name << ": " << line;
  });
}

TEST(HelpTexts, TellHowOptionsGoTogether) {
  CLI::App app("Tries things.", "pole-test");
  double radius = 0.5;
  int count = 3;
  auto* one = addNumber(app, "-r,--radius", radius, "Distance, m", CLI::PositiveNumber);
  app.add_flag("--whole", "All")->excludes(one);
  addNumber(app, "--count", count, "Number", CLI::Range(1, 9))->needs(one);
  int value = 0;
  addChoice<int>(app, "--kind", value, {{"first", 1}, {"second", 2}}, "Kind")->required();
  std::vector<std::string> seen;
  for (const OptionText& option : optionsOf(app, false))
    seen.push_back(option.head() + ": " + option.meaning);
  const std::vector<std::string> expected{
      "-h, --help: Print this help message and exit",
      "-r, --radius NUMBER: Distance, m (above 0; default: 0.5; not with --whole)",
      "--whole: All (not with --radius)", "--count N: Number (1 to 9; default: 3; needs --radius)",
      "--kind first|second: Kind (required)"};
  EXPECT_EQ(seen, expected);
  app.parse("--kind second", false);
  EXPECT_EQ(value, 2);
  EXPECT_THROW(app.parse("--kind 1", false), CLI::ValidationError);
}

}  // namespace polemcl::test_help_texts
