#pragma once
/// \file Html.h
/// \brief Pieces of HTML that are also well-formed XML: text, elements, tables.

#include <string>
#include <vector>

namespace polemcl::report {

/// \brief Any bytes as text of an element or a quoted attribute. What is no UTF-8, and control
/// characters, become U+FFFD.
std::string escaped(const std::string& text);

/// \brief `<name attributes>content</name>`; attributes as they are to stand in the tag.
std::string element(const std::string& name, const std::string& attributes,
                    const std::string& content);
/// \brief `<name>content</name>`.
std::string element(const std::string& name, const std::string& content);

/// \brief The attribute `class="name"`; empty for an empty name.
std::string classed(const std::string& name);

/// \brief A part that can be folded away. \param summary HTML.
std::string foldable(const std::string& summary, const std::string& content, bool open);

/// \brief A cell of the head of a table.
struct HeadCell {
  std::string html;
  std::size_t columns = 1;
};

/// \brief A table in a box of its own that scrolls sideways. Cells are HTML; the first of a row is
/// its header.
class HtmlTable {
 public:
  /// \param caption Text.
  explicit HtmlTable(const std::string& caption) : m_caption(caption) {}
  /// \brief Another row of column headers.
  void head(const std::vector<HeadCell>& cells);
  /// \param className "" or one for the row.
  void row(const std::vector<std::string>& cells, const std::string& className = "");
  /// \brief A row of sums or means, below the others.
  void foot(const std::vector<std::string>& cells);
  /// \param className "" or one for the table.
  std::string str(const std::string& className = "") const;

 private:
  std::string m_caption, m_head, m_body, m_foot;
};

}  // namespace polemcl::report
