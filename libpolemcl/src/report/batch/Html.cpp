#include "report/batch/Html.h"

#include <map>

#include "io/file/TextFile.h"

namespace polemcl::report {
namespace {

constexpr const char* replacement = "\xEF\xBF\xBD";

std::string escapedCharacter(char c) {
  static const std::map<char, const char*> letters{
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
  if (const auto letter = letters.find(c); letter != letters.end()) return letter->second;
  const bool control = (c >= 0 && c < 0x20 && c != '\n' && c != '\t') || c == 0x7F;
  return control ? replacement : std::string(1, c);
}

std::string cells(const std::vector<std::string>& content) {
  std::string row;
  for (std::size_t i = 0; i < content.size(); ++i)
    row += i == 0 ? element("th", "scope=\"row\"", content[i]) : element("td", content[i]);
  return row;
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = io::characterLength(text, i);
    if (length == 0)
      result += replacement;
    else if (length == 1)
      result += escapedCharacter(text[i]);
    else
      result += text.substr(i, length);
    i += length == 0 ? 1 : length;
  }
  return result;
}

std::string element(const std::string& name, const std::string& attributes,
                    const std::string& content) {
  return '<' + name + (attributes.empty() ? "" : ' ' + attributes) + '>' + content + "</" + name +
         '>';
}

std::string element(const std::string& name, const std::string& content) {
  return element(name, "", content);
}

std::string classed(const std::string& name) {
  return name.empty() ? "" : "class=\"" + name + '"';
}

std::string foldable(const std::string& summary, const std::string& content, bool open) {
  return element("details", open ? "open=\"\"" : "", element("summary", summary) + '\n' + content) +
         '\n';
}

void HtmlTable::head(const std::vector<HeadCell>& head) {
  std::string row;
  for (const HeadCell& cell : head) {
    if (cell.html.empty()) {
      row += element("td", "");  // a corner: it heads nothing
      continue;
    }
    row += cell.columns == 1
               ? element("th", "scope=\"col\"", cell.html)
               : element("th", "scope=\"colgroup\" colspan=\"" + std::to_string(cell.columns) + '"',
                         cell.html);
  }
  m_head += element("tr", row) + '\n';
}

void HtmlTable::row(const std::vector<std::string>& content, const std::string& className) {
  m_body += element("tr", classed(className), cells(content)) + '\n';
}

void HtmlTable::foot(const std::vector<std::string>& content) {
  m_foot += element("tr", cells(content)) + '\n';
}

std::string HtmlTable::str(const std::string& className) const {
  std::string table = element("caption", element("span", escaped(m_caption))) + '\n';
  if (!m_head.empty()) table += element("thead", '\n' + m_head) + '\n';
  table += element("tbody", '\n' + m_body) + '\n';
  if (!m_foot.empty()) table += element("tfoot", '\n' + m_foot) + '\n';
  // Focusable, so that the box can be scrolled with the keyboard.
  return element("div",
                 "class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"" +
                     escaped(m_caption) + '"',
                 element("table", classed(className), '\n' + table)) +
         '\n';
}

}  // namespace polemcl::report
