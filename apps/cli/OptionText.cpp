#include "cli/OptionText.h"

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

namespace polemcl::apps {
namespace {

std::string joined(const std::vector<std::string>& parts, const std::string& between) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : between) + part;
  return text;
}

std::vector<std::string> namesOf(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  if (names.empty()) names.push_back(option.get_name(true));
  return names;
}

/// The words of CLI11's "{robot,sensor}".
std::vector<std::string> choicesOf(const std::string& check) {
  std::vector<std::string> words;
  if (check.empty() || check.front() != '{') return words;
  std::istringstream list(check.substr(1, check.find('}') - 1));
  for (std::string word; std::getline(list, word, ',');) words.push_back(word);
  return words;
}

/// What a check allows, in words: "0 to 100" of CLI11's "INT in [0 - 100]".
std::string allowedBy(const std::string& check) {
  if (check.empty() || check.front() == '{') return {};
  std::string text = std::regex_replace(check, std::regex("1e\\+06"), "1000000");
  text = std::regex_replace(text, std::regex("(INT|FLOAT) in \\[(\\S+) - (\\S+)\\]"), "$2 to $3");
  text = std::regex_replace(text, std::regex("NONNEGATIVE"), "0 or more");
  text = std::regex_replace(text, std::regex("POSITIVE"), "above 0");
  return std::regex_replace(text, std::regex("\\(([^()]*)\\) AND \\(([^()]*)\\)"), "$1, $2");
}

/// The names of options that stand in no order, sorted.
std::string sortedNames(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::sort(names.begin(), names.end());
  return joined(names, " ");
}

/// "[71,80]" of a list is typed as "71 80".
std::string defaultOf(const CLI::Option& option) {
  std::string text = option.get_default_str();
  if (text.size() < 2 || text.front() != '[' || text.back() != ']') return text;
  text = text.substr(1, text.size() - 2);
  std::replace(text.begin(), text.end(), ',', ' ');
  return text;
}

std::string notesOf(const CLI::Option& option, const std::string& allowed) {
  std::vector<std::string> notes;
  if (option.get_required()) notes.push_back("required");
  if (!allowed.empty()) notes.push_back(allowed);
  if (const std::string value = defaultOf(option); !value.empty())
    notes.push_back("default: " + value);
  if (!option.get_needs().empty()) notes.push_back("needs " + sortedNames(option.get_needs()));
  if (!option.get_excludes().empty())
    notes.push_back("not with " + sortedNames(option.get_excludes()));
  return notes.empty() ? "" : " (" + joined(notes, "; ") + ")";
}

}  // namespace

std::string OptionText::head() const {
  return joined(names, ", ") + (value.empty() ? "" : " " + value) + (many ? "..." : "");
}

OptionText describe(const CLI::Option& option) {
  OptionText text;
  text.names = namesOf(option);
  text.required = option.get_required();
  std::string check;
  if (option.get_type_size() != 0) {
    // Such as "INT:INT in [0 - 100]": the type, then what the checks say.
    const std::string type = option.get_type_name();
    const std::size_t colon = type.find(':');
    if (colon != std::string::npos) check = type.substr(colon + 1);
    text.choices = choicesOf(check);
    text.value = type.substr(0, colon);
    if (text.value == "FLOAT") text.value = "NUMBER";
    if (text.value == "INT" || text.value == "UINT") text.value = "N";
    if (!text.choices.empty()) text.value = joined(text.choices, "|");
    text.many = option.get_expected_max() == CLI::detail::expected_max_vector_size;
  }
  text.meaning = option.get_description() + notesOf(option, allowedBy(check));
  return text;
}

std::vector<OptionText> optionsOf(const CLI::App& app, bool positional) {
  std::vector<OptionText> texts;
  for (const CLI::Option* option : app.get_options())
    if (option->get_positional() == positional && !option->get_group().empty())
      texts.push_back(describe(*option));
  return texts;
}

std::vector<OptionText> sharedOptions(const CLI::App& app) {
  std::vector<OptionText> texts;
  if (app.get_parent() == nullptr) return texts;
  for (const CLI::Option* option : app.get_parent()->get_options())
    if (option != app.get_parent()->get_help_ptr()) texts.push_back(describe(*option));
  return texts;
}

std::vector<CLI::App*> subcommandsOf(CLI::App& app) {
  return app.get_subcommands([](CLI::App*) { return true; });
}

std::vector<const CLI::App*> subcommandsOf(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string usageOf(const CLI::App& app, const std::string& name) {
  std::string usage = name;
  if (!subcommandsOf(app).empty()) return usage + " SUBCOMMAND [OPTIONS]";
  for (const OptionText& argument : optionsOf(app, true))
    usage += argument.required ? " " + argument.names.front() : " [" + argument.names.front() + "]";
  for (const OptionText& option : optionsOf(app, false))
    if (option.required) usage += " " + option.head();
  return usage + " [OPTIONS]";
}

}  // namespace polemcl::apps
