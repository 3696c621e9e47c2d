#include "cli/ManPage.h"

#include <algorithm>

#include "cli/Guides.h"
#include "cli/OptionText.h"
#include "cli/Version.h"

namespace polemcl::apps {
namespace {

/// A text that troff prints as it is.
std::string troff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '\\':
        out += "\\e";
        break;
      case '-':
        out += "\\-";
        break;
      case '\'':
        out += "\\(aq";
        break;
      case '`':
        out += "\\(ga";
        break;
      case '~':
        out += "\\(ti";
        break;
      case '^':
        out += "\\(ha";
        break;
      default:
        out += c;
    }
  }
  return (!out.empty() && out.front() == '.' ? "\\&" : "") + out;
}

std::string section(const std::string& title) {
  return ".SH " + title + '\n';
}

/// "--input FILE...": names in bold, the value in italics.
std::string manHead(const OptionText& option) {
  std::string head;
  for (const std::string& name : option.names)
    head += (head.empty() ? "\\fB" : ", \\fB") + troff(name) + "\\fR";
  if (!option.value.empty()) head += " \\fI" + troff(option.value) + "\\fR";
  return head + (option.many ? "..." : "");
}

std::string optionSection(const std::string& title, const std::vector<OptionText>& options) {
  std::string text = options.empty() ? "" : section(title);
  for (const OptionText& option : options)
    text += ".TP\n" + manHead(option) + '\n' + troff(option.meaning) + '\n';
  return text;
}

std::string commandSection(const CLI::App& app, const std::string& name) {
  const auto commands = subcommandsOf(app);
  std::string text = commands.empty() ? "" : section("SUBCOMMANDS");
  for (const CLI::App* command : commands)
    text += ".TP\n\\fB" + troff(command->get_name()) + "\\fR\n" +
            troff(command->get_description()) + ".\nSee \\fB" +
            troff(manPageName(name + ' ' + command->get_name())) + "\\fR(1).\n";
  return text;
}

std::string guideSections(const Guide& guide) {
  std::string text = guide.examples.empty() ? "" : section("EXAMPLES") + ".nf\n";
  for (const std::string& example : guide.examples) text += troff(example) + '\n';
  if (!guide.examples.empty()) text += ".fi\n";
  if (!guide.next.empty()) text += section("NEXT") + troff(guide.next) + '\n';
  return text;
}

/// What holds for all programs.
constexpr const char* s_commonSections = R"(.SH EXIT STATUS
.TP
0
Done.
.TP
1
Failed; one line on standard error says what, where and what to do.
.TP
2
Wrong usage.
.SH ENVIRONMENT
.TP
NO_COLOR
If set and not empty: no colours on terminals.
.SH FILES
Settings and models are looked for by their names in
.I ../share/polemcl/config
and
.IR ../share/polemcl/models ,
seen from the folder of the program.
)";

std::string seeAlso(const CLI::App& app) {
  std::vector<std::string> pages{"pole-import", "pole-extract",  "pole-map",   "pole-localize",
                                 "pole-eval",   "pole-simulate", "pole-batch", "pole-labels"};
  if (app.get_parent() == nullptr)
    pages.erase(std::remove(pages.begin(), pages.end(), app.get_name()), pages.end());
  std::string text = section("SEE ALSO");
  for (const std::string& page : pages)
    text += ".BR " + troff(page) + " (1)" + (page == pages.back() ? "\n" : " ,\n");
  return text;
}

}  // namespace

std::string manPageName(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string manPage(const CLI::App& app, const std::string& name, const std::string& date) {
  const std::string page = manPageName(name);
  std::string title = page, what = app.get_description();
  std::transform(title.begin(), title.end(), title.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  if (what.back() == '.') what.pop_back();
  std::string text = ".TH " + troff(title) + " 1 " + date + " \"polemcl " + version() +
                     "\" \"User commands\"\n" + section("NAME") + troff(page) + " \\- " +
                     troff(what) + '\n' + section("SYNOPSIS") + troff(usageOf(app, name)) + '\n' +
                     section("DESCRIPTION") + troff(what) + ".\n";
  text += commandSection(app, name) + optionSection("ARGUMENTS", optionsOf(app, true)) +
          optionSection("OPTIONS", optionsOf(app, false)) +
          optionSection("OPTIONS OF ALL SUBCOMMANDS", sharedOptions(app));
  return text + guideSections(guideOf(name)) + s_commonSections + seeAlso(app);
}

}  // namespace polemcl::apps
