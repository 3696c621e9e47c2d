#pragma once
/// \file CsvRows.h
/// \brief Long tables of comma-separated numbers without a header, read row by row.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace polemcl::io {

/// \brief Called with the amount read and the total, both in the same unit.
using ReadProgress = std::function<void(std::size_t done, std::size_t total)>;

/// \brief Reads one row at a time and stores none, so that files may have any length. Blank lines
/// and lines that start with `#` are skipped; `nan` and `inf` are accepted as numbers.
class CsvRows {
 public:
  /// \param layout The columns, for messages: "utime, x, y".
  /// \param progress Called at intervals with the megabytes read and the size of the file; may be
  ///        empty.
  /// \throws Error when the file cannot be read.
  CsvRows(const std::filesystem::path& file, std::size_t columns, std::string layout,
          ReadProgress progress = {});

  /// \brief The next row. \return False at the end.
  /// \throws Error with file and line: wrong number of columns, not a number, failed read.
  bool next(std::vector<double>& values);
  /// \brief "FILE:LINE: " of the last row read, for messages.
  std::string at() const;

 private:
  std::filesystem::path m_file;
  std::size_t m_columns, m_line = 0;
  std::string m_layout, m_text;
  ReadProgress m_progress;
  std::uint64_t m_size = 0, m_read = 0;  ///< bytes
  std::ifstream m_stream;
};

/// \brief Whether no number of a row is NaN or infinite.
bool allFinite(const std::vector<double>& row);

}  // namespace polemcl::io
