#pragma once
/// \file CsvTable.h
/// \brief Tables with named columns: CSV with a header line.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace polemcl::io {

/// \brief A CSV file in memory. Fields are separated by commas, or as told, and may be quoted.
/// Blank lines and lines that start with `#` are skipped; the first other line names the columns.
class CsvTable {
 public:
  /// \throws Error with file and line: file not readable, empty, a quote that is not closed, a row
  ///         whose number of fields differs from the header.
  explicit CsvTable(const std::filesystem::path& file, char separator = ',');

  std::size_t rows() const { return m_rows.size(); }
  /// \brief Names of the columns, in their order.
  const std::vector<std::string>& names() const { return m_header.fields; }
  /// \brief Index of the column with this name. \throws Error unless there is exactly one.
  std::size_t column(const std::string& name) const;
  /// \brief As column(), for optional columns. \throws Error when there are several.
  std::optional<std::size_t> find(const std::string& name) const;
  /// \brief A field as a number. \throws Error with file and line unless it is finite.
  double number(std::size_t row, std::size_t column) const;
  /// \brief A field as a whole number. \throws Error with file and line unless it is from 0 to
  ///        4294967295.
  std::uint32_t count(std::size_t row, std::size_t column) const;
  /// \brief A field as text, without surrounding spaces and quotes.
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
