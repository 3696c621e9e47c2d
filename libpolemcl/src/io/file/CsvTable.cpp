#include "io/file/CsvTable.h"

#include <algorithm>
#include <cmath>

#include <polemcl/core/common/Types.h>
#include "io/file/TextFile.h"

namespace polemcl::io {
namespace {

/// Splits a line at separators; removes quotes and spaces around the fields.
std::vector<std::string> splitCsv(std::string_view line, char separator, const std::string& where) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[++i];  // a doubled quote stands for one
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == separator && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  if (quoted) throw Error(where + "a quote is not closed");
  for (std::string& field : fields) field = std::string(trimmed(field));
  return fields;
}

}  // namespace

CsvTable::CsvTable(const std::filesystem::path& file, char separator) : m_file(file) {
  LineReader lines(file);
  std::string whole;
  for (std::size_t number = 1; lines.next(whole); ++number) {
    const std::string_view line = trimmed(whole);
    if (line.empty() || line.front() == '#') continue;
    lines.keep(2 + static_cast<std::size_t>(std::count(line.begin(), line.end(), separator)));
    const std::string where = io::at(file, number);
    // A tab at an end of the line may be a separator.
    Row row{number, splitCsv(separator == '\t' ? whole : line, separator, where)};
    if (m_header.fields.empty()) {
      m_header = std::move(row);
    } else if (row.fields.size() != m_header.fields.size()) {
      throw Error(where + std::to_string(row.fields.size()) + " fields, " +
                  std::to_string(m_header.fields.size()) + " expected as in the header");
    } else {
      m_rows.push_back(std::move(row));
    }
  }
  if (m_header.fields.empty())
    throw Error(file.string() + ": empty; a header that names the columns (x,y,…) expected");
}

std::size_t CsvTable::column(const std::string& name) const {
  const auto& header = m_header.fields;
  if (std::count(header.begin(), header.end(), name) != 1) {
    throw Error(io::at(m_file, m_header.line) + "one column named " + name +
                " expected; the first line has to name the columns (x,y,…)");
  }
  return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
}

std::optional<std::size_t> CsvTable::find(const std::string& name) const {
  const auto& header = m_header.fields;
  if (std::count(header.begin(), header.end(), name) == 0) return std::nullopt;
  return column(name);
}

double CsvTable::number(std::size_t row, std::size_t column) const {
  const std::string& field = m_rows[row].fields[column];
  const auto value = parseNumber(field);
  if (!value || !std::isfinite(*value))
    throw Error(at(row) + "'" + field + "' is not a finite number");
  return *value;
}

std::uint32_t CsvTable::count(std::size_t row, std::size_t column) const {
  const double value = number(row, column);
  if (!(value >= 0 && value <= 4294967295.0 && value == std::floor(value)))
    throw Error(at(row) + m_header.fields[column] + " must be a whole number from 0 to 4294967295");
  return static_cast<std::uint32_t>(value);
}

std::string CsvTable::at(std::size_t row) const {
  return io::at(m_file, m_rows[row].line);
}

}  // namespace polemcl::io
