#include "cli/HelpFormatter.h"

#include <sstream>

#include "cli/Guides.h"
#include "cli/OptionText.h"

namespace polemcl::apps {
namespace {

constexpr std::size_t s_helpWidth = 80;   // of a line
constexpr std::size_t s_helpColumn = 26;  // where the meanings begin

/// Adds the words of a text, in lines that begin at a column, to a text whose line has `at`
/// characters.
void wrap(std::string& text, std::size_t at, std::size_t column, const std::string& meaning) {
  std::istringstream words(meaning);
  bool begins = true;  // a line
  for (std::string word; words >> word; begins = false) {
    if (!begins && at + 1 + word.size() > s_helpWidth) {
      text += '\n';
      at = 0;
      begins = true;
    }
    const std::string gap(begins ? column - at : 1, ' ');
    text += gap + word;
    at += gap.size() + word.size();
  }
  text += '\n';
}

/// "  --name VALUE   What it means", the meaning on a line of its own where the head is long.
void addEntry(std::string& text, const std::string& head, const std::string& meaning) {
  text += "  " + head;
  std::size_t at = 2 + head.size();
  if (at + 2 > s_helpColumn) {
    text += '\n';
    at = 0;
  }
  wrap(text, at, s_helpColumn, meaning);
}

void addGroup(std::string& text, const std::string& title, const std::vector<OptionText>& options) {
  if (options.empty()) return;
  text += "\n" + title + ":\n";
  for (const OptionText& option : options) addEntry(text, option.head(), option.meaning);
}

void addShared(std::string& text, const CLI::App& app) {
  if (app.get_parent() == nullptr) return;
  std::string names;
  for (const OptionText& option : sharedOptions(app)) names += option.names.back() + ", ";
  text += "\nOptions of all subcommands:\n";
  wrap(text, 0, 2, names + "see " + app.get_parent()->get_name() + " --help");
}

void addGuide(std::string& text, const std::string& name) {
  const Guide& guide = guideOf(name);
  if (!guide.examples.empty()) text += "\nExamples:\n";
  for (const std::string& example : guide.examples) text += "  " + example + '\n';
  if (guide.next.empty()) return;
  text += "\nNext:\n";
  wrap(text, 0, 2, guide.next);
}

}  // namespace

std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode) const {
  std::string text;
  wrap(text, 0, 0, app->get_description());
  text += "\nUsage: " + usageOf(*app, name) + '\n';
  const auto commands = subcommandsOf(*app);
  if (!commands.empty()) text += "\nSubcommands:\n";
  for (const CLI::App* command : commands)
    addEntry(text, command->get_name(), command->get_description());
  addGroup(text, "Arguments", optionsOf(*app, true));
  addGroup(text, "Options", optionsOf(*app, false));
  addShared(text, *app);
  addGuide(text, name);
  return text;
}

}  // namespace polemcl::apps
