#include "cli/HelpFormatter.h"

#include <algorithm>
#include <regex>
#include <set>
#include <vector>

#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

constexpr std::size_t kLineWidth = 80;
constexpr std::size_t kMeaningColumn = 26;  // where the meanings begin

/// Words in lines that begin at a column; the first line has `at` characters already.
std::string wrapped(const std::string& text, std::size_t column, std::size_t at = 0) {
  std::string lines;
  for (const std::string& word : io::wordsOf(text)) {
    if (at > column && at + 1 + word.size() > kLineWidth) {
      lines += '\n';
      at = 0;
    }
    const std::size_t gap = at < column ? column - at : at > 0 ? 1 : 0;
    lines += std::string(gap, ' ') + word;
    at += gap + word.size();
  }
  return lines + '\n';
}

/// "  --name VALUE   What it means"; the meaning is on a line of its own where the head is long.
std::string entry(const std::string& head, const std::string& meaning) {
  std::string text = "  " + head;
  if (text.size() + 2 <= kMeaningColumn)
    return text + wrapped(meaning, kMeaningColumn, text.size());
  return text + '\n' + wrapped(meaning, kMeaningColumn);
}

/// The value of an option and what is allowed, of CLI11's `INT:INT in [0 - 9]` or
/// `TEXT:{robot,sensor}`.
struct ValueText {
  std::string value, allowed;
};
ValueText valueOf(const CLI::Option& option) {
  if (option.get_type_size() == 0) return {};  // a flag
  const std::string type = option.get_type_name();
  const std::size_t colon = std::min(type.find(':'), type.size());
  ValueText text{type.substr(0, colon), type.substr(std::min(colon + 1, type.size()))};
  if (text.value == "FLOAT") text.value = "NUMBER";
  if (text.value == "INT" || text.value == "UINT") text.value = "N";
  if (!text.allowed.empty() && text.allowed.front() == '{') {
    const std::string words = text.allowed.substr(1, text.allowed.find('}') - 1);
    return {std::regex_replace(words, std::regex(","), "|"), ""};
  }
  const std::vector<std::pair<std::string, std::string>> inWords{
      {"1e\\+06", "1000000"},
      {"(INT|FLOAT) in \\[(\\S+) - (\\S+)\\]", "$2 to $3"},
      {"NONNEGATIVE", "0 or more"},
      {"POSITIVE", "above 0"},
      {"\\(([^()]*)\\) AND \\(([^()]*)\\)", "$1, $2"}};
  for (const auto& [theirs, ours] : inWords)
    text.allowed = std::regex_replace(text.allowed, std::regex(theirs), ours);
  return text;
}

/// Such as `-h, --help` or `--input FILE...`.
std::string headOf(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  if (names.empty()) names.push_back(option.get_name());  // an argument
  const std::string value = valueOf(option).value;
  const bool many = option.get_expected_max() == CLI::detail::expected_max_vector_size;
  return CLI::detail::join(names, ", ") + (value.empty() ? "" : " " + value) + (many ? "..." : "");
}

/// Names in an order that is the same in each run.
std::string namesOf(const std::set<CLI::Option*>& options) {
  std::set<std::string> names;
  for (const CLI::Option* option : options) names.insert(option->get_name());
  return CLI::detail::join(names, " ");
}

std::string meaningOf(const CLI::Option& option) {
  std::vector<std::string> notes;
  if (option.get_required()) notes.push_back("required");
  if (const auto allowed = valueOf(option).allowed; !allowed.empty()) notes.push_back(allowed);
  if (const auto value = option.get_default_str(); !value.empty())
    notes.push_back("default: " + value);
  if (!option.get_needs().empty()) notes.push_back("needs " + namesOf(option.get_needs()));
  if (!option.get_excludes().empty()) notes.push_back("not with " + namesOf(option.get_excludes()));
  return option.get_description() +
         (notes.empty() ? "" : " (" + CLI::detail::join(notes, "; ") + ")");
}

std::string usageOf(const CLI::App& app, const std::string& name) {
  std::string usage = "Usage: " + name;
  if (app.get_require_subcommand_min() > 0) return usage + " SUBCOMMAND [OPTIONS]\n";
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional())
      usage += option->get_required() ? " " + option->get_name() : " [" + option->get_name() + "]";
    else if (option->get_required())
      usage += " " + headOf(*option);
  }
  return usage + " [OPTIONS]\n";
}

std::string optionsText(const std::string& title, const CLI::App& app, bool positional) {
  std::string text;
  for (const CLI::Option* option : app.get_options())
    if (option->get_positional() == positional && !option->get_group().empty())  // empty: hidden
      text += entry(headOf(*option), meaningOf(*option));
  return text.empty() ? "" : "\n" + title + ":\n" + text;
}

/// What a subcommand takes from its program, such as `--quiet`.
std::string sharedOptions(const CLI::App* program) {
  if (!program) return "";
  std::string names;
  for (const CLI::Option* option : program->get_options())
    if (option != program->get_help_ptr()) names += option->get_name() + ", ";
  return "\nOptions of all subcommands:\n" +
         wrapped(names + "see " + program->get_name() + " --help", 2);
}

std::string subcommandsText(const CLI::App& app) {
  std::string text;
  for (const CLI::App* command : app.get_subcommands({}))
    text += entry(command->get_name(), command->get_description());
  return text.empty() ? "" : "\nSubcommands:\n" + text;
}

}  // namespace

std::string guideText(const Guide& guide) {
  std::string text;
  for (const std::string& example : guide.examples) text += "  " + example + '\n';
  return "\nExamples:\n" + text + "\nNext:\n" + wrapped(guide.next, 2);
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode) const {
  return wrapped(app->get_description(), 0) + '\n' + usageOf(*app, name) + subcommandsText(*app) +
         optionsText("Arguments", *app, true) + optionsText("Options", *app, false) +
         sharedOptions(app->get_parent()) + app->get_footer();
}

}  // namespace polemcl::apps
