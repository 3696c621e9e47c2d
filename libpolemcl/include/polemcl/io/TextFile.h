#pragma once
/// \file TextFile.h
/// \brief Strict tables of numbers, and numbers to text and back, in no locale but "C".

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace polemcl::io {

/// \brief One line of a table, with its 1-based line number for messages.
struct NumberRow {
  std::size_t line = 0;
  std::vector<double> values;
};

/// \brief All lines of a text file, without line ends (`\n` or `\r\n`), blank ones included. Plain
/// or gzip. A byte order mark is dropped. \throws Error when it cannot be read or is cut short.
std::vector<std::string> readLines(const std::filesystem::path& file);

/// \brief Lines of exactly `columns` numbers between spaces or tabs. `#` starts a comment; blank
/// lines are skipped.
/// \param layout The columns, for messages: "time x y".
/// \throws Error naming file and line: another count of columns, no number, NaN or infinite.
std::vector<NumberRow> readNumberRows(const std::filesystem::path& file, std::size_t columns,
                                      const std::string& layout);

/// \brief The numbers of one line. \throws Error "FILE:LINE: …" as readNumberRows().
std::vector<double> parseNumbers(std::string_view text, const std::filesystem::path& file,
                                 std::size_t line);

/// \brief The whole text as one number (surrounding spaces allowed); none when it is not one.
/// `nan` and `inf` are numbers here.
std::optional<double> parseNumber(std::string_view text);

/// \brief The text without spaces, tabs and carriage returns at its ends.
std::string_view trimmed(std::string_view text);

/// \brief With so many decimals: 1.5 -> "1.500000".
std::string fixed(double value, int decimals);
/// \brief With so many significant digits, as short as possible: 0.01 -> "0.01".
std::string significant(double value, int digits);

/// \brief "FILE:LINE: ", the start of a message.
std::string at(const std::filesystem::path& file, std::size_t line);

}  // namespace polemcl::io
