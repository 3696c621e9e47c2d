#include "cli/CommandPage.h"

#include <algorithm>

#include "cli/Guides.h"
#include "cli/OptionText.h"

namespace polemcl::apps {
namespace {

/// A text within a table: a bar would end the cell, and words in angle brackets would be HTML.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '*' || c == '_') out += '\\';
    out += c;
  }
  return out;
}

std::string row(const OptionText& option) {
  std::string head = option.head();
  for (std::size_t at = 0; (at = head.find('|', at)) != std::string::npos; at += 2)
    head.insert(at, "\\");
  return "| `" + head + "` | " + cell(option.meaning) + " |\n";
}

std::vector<std::string> rowsOf(const CLI::App& app) {
  std::vector<std::string> rows;
  for (const bool positional : {true, false})
    for (const OptionText& option : optionsOf(app, positional))
      if (option.names.back() != "--help") rows.push_back(row(option));
  return rows;
}

/// The rows that all subcommands have, such as `--output` of all that import.
std::vector<std::string> commonRows(const std::vector<const CLI::App*>& commands) {
  if (commands.size() < 2) return {};
  std::vector<std::string> common = rowsOf(*commands.front());
  for (const CLI::App* command : commands) {
    const auto rows = rowsOf(*command);
    const auto lacks = [&](const std::string& row) {
      return std::find(rows.begin(), rows.end(), row) == rows.end();
    };
    common.erase(std::remove_if(common.begin(), common.end(), lacks), common.end());
  }
  return common;
}

std::string table(const std::vector<std::string>& rows, const std::vector<std::string>& but = {}) {
  std::string text;
  for (const std::string& row : rows)
    if (std::find(but.begin(), but.end(), row) == but.end()) text += row;
  return text.empty() ? "" : "\n| option | meaning |\n|---|---|\n" + text;
}

std::string examples(const std::string& name) {
  std::string text;
  for (const std::string& example : guideOf(name).examples) text += example + '\n';
  return text.empty() ? "" : "\n```sh\n" + text + "```\n";
}

std::string opening(const CLI::App& app, const std::string& name) {
  return '\n' + cell(app.get_description()) + "\n\n`" + usageOf(app, name) + "`\n";
}

}  // namespace

std::string commandPage(const CLI::App& app) {
  const std::string name = app.get_name();
  const auto commands = subcommandsOf(app);
  const auto common = commonRows(commands);
  std::string text = "# " + name + '\n' + opening(app, name);
  if (commands.empty()) text += examples(name);
  text += table(rowsOf(app));
  if (!common.empty()) text += "\n## Options of all subcommands\n" + table(common);
  for (const CLI::App* command : commands) {
    const std::string full = name + ' ' + command->get_name();
    text += "\n## " + full + '\n' + opening(*command, full) + examples(full) +
            table(rowsOf(*command), common);
  }
  return text +
         "\nThis page is made from the declarations of the options: "
         "`POLEMCL_WRITE_PAGES=1 build/bin/test_apps --gtest_filter='CommandPages.*'`\n";
}

}  // namespace polemcl::apps
