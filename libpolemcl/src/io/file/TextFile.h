#pragma once
/// \file TextFile.h
/// \brief Strict tables of numbers, and conversion of numbers to and from text, always in the "C"
/// locale.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct gzFile_s;

namespace polemcl::io {

/// \brief One line of a table, with its 1-based line number for messages.
struct NumberRow {
  std::size_t line = 0;
  std::vector<double> values;
};

/// \brief Reads the lines of a text file one by one, including blank ones, without line ends (`\n`
/// or `\r\n`). Plain text or gzip. A byte order mark is dropped.
class LineReader {
 public:
  /// \throws Error when the file cannot be opened, or is no input (InputFile.h).
  explicit LineReader(const std::filesystem::path& file);
  /// \return False at the end. \throws Error when the file cannot be read, is truncated, or holds
  ///         more than allowed (ReadLimits.h).
  bool next(std::string& line);
  /// \brief Tells how many lines and fields the caller keeps: each takes memory, however short it
  /// is. \throws Error when a file of this size cannot hold that many (ReadLimits.h).
  void keep(std::size_t entries);
  /// \brief Size of the file, and how much of it was read; bytes, as it lies on the disk.
  std::uint64_t size() const { return m_size; }
  std::uint64_t done() const;

 private:
  void readBlock();

  std::filesystem::path m_file;
  std::unique_ptr<gzFile_s, int (*)(gzFile_s*)> m_stream;
  std::string m_text;  ///< text read; the part from m_begin on is not returned yet
  std::size_t m_begin = 0;
  std::size_t m_read = 0;  ///< bytes, uncompressed
  std::uint64_t m_size = 0, m_most = 0, m_kept = 0;
  bool m_ended = false, m_cutShort = false;
};

/// \brief All lines, see LineReader. \throws Error as LineReader does.
std::vector<std::string> readLines(const std::filesystem::path& file);

/// \brief What stands between the numbers of a row. Between commas, a number may be `nan` or `inf`.
enum class Separator { blanks, commas };

/// \brief Called with the amount read and the total, both in the same unit.
using ReadProgress = std::function<void(std::size_t done, std::size_t total)>;

/// \brief Reads lines of exactly `columns` numbers, one at a time, so that files may have any
/// length. `#` starts a comment; blank lines are skipped. Plain text or gzip.
class NumberRowReader {
 public:
  /// \param layout The columns, for messages: "time x y".
  /// \param progress Called at intervals with the megabytes read and the size of the file; may be
  ///        empty.
  /// \throws Error as LineReader.
  NumberRowReader(const std::filesystem::path& file, std::size_t columns, std::string layout,
                  Separator separator = Separator::blanks, ReadProgress progress = {});
  /// \return False at the end.
  /// \throws Error with file and line: wrong number of columns, not a number, failed read.
  bool next(std::vector<double>& values);
  /// \brief As LineReader::keep(), for callers that keep the rows.
  void keep(std::size_t rows) { m_lines.keep(rows); }
  /// \brief The line read last, from 1 on; with the file for messages, "FILE:LINE: ".
  std::size_t line() const { return m_line; }
  std::string at() const;

 private:
  LineReader m_lines;
  std::filesystem::path m_file;
  std::size_t m_columns, m_line = 0;
  std::string m_layout, m_text;
  Separator m_separator;
  ReadProgress m_progress;
};

/// \brief All rows, see NumberRowReader.
std::vector<NumberRow> readNumberRows(const std::filesystem::path& file, std::size_t columns,
                                      const std::string& layout);

/// \brief The numbers of one line. \param layout For messages, if not empty.
/// \throws Error "FILE:LINE: …" for what is no number.
std::vector<double> parseNumbers(std::string_view text, const std::filesystem::path& file,
                                 std::size_t line, const std::string& layout = {},
                                 Separator separator = Separator::blanks);

/// \brief Whether no number of a row is NaN or infinite.
bool allFinite(const std::vector<double>& row);

/// \brief Parses the whole text as one number (surrounding spaces allowed); nullopt if it is not a
/// number. `nan` and `inf` are accepted.
std::optional<double> parseNumber(std::string_view text);

/// \brief Length of the UTF-8 character that begins at this byte; 0 when no character begins there.
std::size_t characterLength(std::string_view text, std::size_t at);

/// \brief The text without spaces, tabs and carriage returns at its ends.
std::string_view trimmed(std::string_view text);

/// \brief The words of a text, which white space separates.
std::vector<std::string> wordsOf(std::string_view text);
/// \brief A list of the texts: "a, b".
template <class Texts>
std::string joined(const Texts& texts, const std::string& between = ", ") {
  std::string list;
  for (const std::string& text : texts) list += (list.empty() ? "" : between) + text;
  return list;
}

/// \brief Text with this number of decimals: 1.5 -> "1.500000".
std::string fixed(double value, int decimals);
/// \brief Text with at most this number of significant digits, as short as possible: 0.01 ->
/// "0.01".
std::string significant(double value, int digits);

/// \brief "FILE:LINE: ", the prefix of a message.
std::string at(const std::filesystem::path& file, std::size_t line);

}  // namespace polemcl::io
