#pragma once
/// \file CsvTable.h
/// \brief Tables with named columns: CSV with a header line.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace polemcl::io {

/// \brief A CSV file in memory. Fields are between commas, optionally in quotes; blank lines and
/// lines that start with `#` are skipped; the first other line names the columns.
class CsvTable {
 public:
  /// \throws Error naming file and line: cannot be read, empty, a quote that is not closed, a row
  ///         with another number of fields than the header.
  explicit CsvTable(const std::filesystem::path& file);

  std::size_t rows() const { return m_rows.size(); }
  /// \brief Index of the column of that name. \throws Error unless there is exactly one.
  std::size_t column(const std::string& name) const;
  /// \brief The same where it may be missing. \throws Error when there are several.
  std::optional<std::size_t> find(const std::string& name) const;
  /// \brief A field as a number. \throws Error naming file and line unless it is finite.
  double number(std::size_t row, std::size_t column) const;
  /// \brief A field as it stands, without spaces and quotes round it.
  const std::string& text(std::size_t row, std::size_t column) const {
    return m_rows[row].fields[column];
  }
  /// \brief "FILE:LINE: " of a row, for messages.
  std::string at(std::size_t row) const;

 private:
  struct Row {
    std::size_t line = 0;
    std::vector<std::string> fields;
  };
  std::filesystem::path m_file;
  Row m_header;
  std::vector<Row> m_rows;
};

}  // namespace polemcl::io
