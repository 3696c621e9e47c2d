#include "io/file/TextFile.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

#include <polemcl/core/common/Types.h>
#include "io/file/InputFile.h"
#include "io/file/ReadLimits.h"

namespace polemcl::io {

LineReader::LineReader(const std::filesystem::path& file)
    : m_file(file), m_stream(nullptr, &gzclose) {
  const auto fail = [&](const std::string& why) {
    return Error("cannot read " + file.string() + ": " + why);
  };
  if (const char* why = whyNoInput(file)) throw fail(why);
  std::error_code ignored;
  const auto size = std::filesystem::file_size(file, ignored);
  if (!ignored) m_size = size;
  errno = 0;
  m_stream.reset(gzopen(file.c_str(), "rb"));
  if (!m_stream) throw fail(errno != 0 ? std::strerror(errno) : "out of memory");
  const bool isPlain = !ignored && gzdirect(m_stream.get()) != 0;
  m_most = isPlain ? mostInflated(m_size)
                   : std::min<std::uint64_t>(kMostTextBytes, mostInflated(m_size));
  readBlock();
  if (std::string_view(m_text).substr(0, 3) == "\xEF\xBB\xBF") m_begin = 3;
}

void LineReader::readBlock() {
  std::array<char, 65536> block;
  const int got = gzread(m_stream.get(), block.data(), block.size());
  int code = Z_OK;
  const char* message = gzerror(m_stream.get(), &code);
  // A truncated gzip file is readable to its end first, and zlib 1.3.2 tells only once that it is.
  if (code == Z_BUF_ERROR) m_cutShort = true;
  if (got > 0) {
    m_text.erase(0, m_begin);
    m_begin = 0;
    m_text.append(block.data(), static_cast<std::size_t>(got));
    m_read += static_cast<std::size_t>(got);
    if (m_read > m_most)
      throw Error("cannot read " + m_file.string() + ": it holds more than " +
                  std::to_string(m_most >> 20) +
                  " MB of text, uncompressed; no table of its size is that large");
    return;
  }
  m_ended = true;
  if (got < 0 || code != Z_OK || m_cutShort)
    throw Error("cannot read " + m_file.string() + ": " +
                (code == Z_ERRNO ? std::strerror(errno)
                 : m_cutShort    ? "the gzip data is cut short"
                                 : message));
}

bool LineReader::next(std::string& line) {
  std::size_t end = m_text.find('\n', m_begin);
  while (end == std::string::npos && !m_ended) {
    const std::size_t seen = m_text.size() - m_begin;
    readBlock();
    end = m_text.find('\n', m_begin + (m_ended ? 0 : seen));
  }
  if (m_begin == m_text.size()) return false;
  line.assign(m_text, m_begin, end == std::string::npos ? end : end - m_begin);
  m_begin = end == std::string::npos ? m_text.size() : end + 1;
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return true;
}

void LineReader::keep(std::size_t entries) {
  m_kept += entries;
  if (m_kept > (kMostTextBytes + mostInflated(m_size)) / kKeptTextBytes)
    throw Error("cannot read " + m_file.string() + ": it holds more than " +
                std::to_string(m_kept - entries) +
                " lines and fields; no table of its size has that many");
}

std::uint64_t LineReader::done() const {
  return static_cast<std::uint64_t>(std::max<z_off_t>(0, gzoffset(m_stream.get())));
}

std::string at(const std::filesystem::path& file, std::size_t line) {
  return file.string() + ":" + std::to_string(line) + ": ";
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> wordsOf(std::string_view text) {
  constexpr const char* kWhite = " \t\r\n\v\f";
  std::vector<std::string> words;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(kWhite), text.size()));
    if (text.empty()) return words;
    words.emplace_back(text.substr(0, text.find_first_of(kWhite)));
    text.remove_prefix(words.back().size());
  }
}

std::vector<std::string> readLines(const std::filesystem::path& file) {
  LineReader reader(file);
  std::vector<std::string> lines;
  for (std::string line; reader.next(line);) {
    reader.keep(1);
    lines.push_back(line);
  }
  return lines;
}

std::optional<double> parseNumber(std::string_view text) {
  text = trimmed(text);
  if (!text.empty() && text.front() == '+') {
    text.remove_prefix(1);
    if (!text.empty() && text.front() == '-') return std::nullopt;
  }
  double value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

std::vector<double> parseNumbers(std::string_view text, const std::filesystem::path& file,
                                 std::size_t line, const std::string& layout, Separator separator) {
  const bool isCsv = separator == Separator::commas;
  std::vector<double> values;
  text = trimmed(text);
  for (bool more = !text.empty(); more;) {
    const std::size_t end = text.find_first_of(isCsv ? "," : " \t");
    const std::string_view word = trimmed(text.substr(0, end));
    const auto value = parseNumber(word);
    if (!value || !(isCsv || std::isfinite(*value)))
      throw Error(at(file, line) + "'" + std::string(word.substr(0, 40)) +
                  (isCsv ? "' is not a number" : "' is not a finite number") +
                  (layout.empty() ? "" : "; expected: " + layout));
    values.push_back(*value);
    more = end != std::string_view::npos;
    if (more) text = trimmed(text.substr(end + 1));
  }
  return values;
}

bool allFinite(const std::vector<double>& row) {
  return std::all_of(row.begin(), row.end(), [](double v) { return std::isfinite(v); });
}

NumberRowReader::NumberRowReader(const std::filesystem::path& file, std::size_t columns,
                                 std::string layout, Separator separator, ReadProgress progress)
    : m_lines(file),
      m_file(file),
      m_columns(columns),
      m_layout(std::move(layout)),
      m_separator(separator),
      m_progress(std::move(progress)) {}

std::string NumberRowReader::at() const {
  return io::at(m_file, m_line);
}

bool NumberRowReader::next(std::vector<double>& values) {
  constexpr std::size_t kLinesPerReport = 10000, kMegabyte = 1000000;
  while (m_lines.next(m_text)) {
    ++m_line;
    if (m_progress && m_line % kLinesPerReport == 0)
      m_progress(m_lines.done() / kMegabyte, m_lines.size() / kMegabyte);
    const auto line = trimmed(std::string_view(m_text).substr(0, m_text.find('#')));
    if (line.empty()) continue;
    values = parseNumbers(line, m_file, m_line, m_layout, m_separator);
    if (values.size() != m_columns)
      throw Error(at() + std::to_string(values.size()) + " numbers, " + std::to_string(m_columns) +
                  " expected: " + m_layout);
    return true;
  }
  return false;
}

std::vector<NumberRow> readNumberRows(const std::filesystem::path& file, std::size_t columns,
                                      const std::string& layout) {
  NumberRowReader reader(file, columns, layout);
  std::vector<NumberRow> rows;
  for (std::vector<double> values; reader.next(values);) {
    reader.keep(1);
    rows.push_back({reader.line(), std::move(values)});
  }
  return rows;
}

namespace {

bool continues(std::string_view text, std::size_t at) {
  return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80;
}

std::string formatted(double value, std::chars_format format, int precision) {
  // Enough for the largest double in fixed notation.
  std::array<char, 512> buffer;
  const auto result =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format, precision);
  return std::string(buffer.data(), result.ptr);
}

}  // namespace

std::size_t characterLength(std::string_view text, std::size_t at) {
  const auto first = static_cast<unsigned char>(text[at]);
  if (first < 0x80) return 1;
  if (first < 0xC2 || first > 0xF4 || !continues(text, at + 1)) return 0;
  if (first < 0xE0) return 2;
  const auto second = static_cast<unsigned char>(text[at + 1]);
  if (first < 0xF0) {
    // Neither too long a form nor half of a pair (UTF-16).
    const bool allowed = (first != 0xE0 || second >= 0xA0) && (first != 0xED || second < 0xA0);
    return allowed && continues(text, at + 2) ? 3 : 0;
  }
  const bool allowed = (first != 0xF0 || second >= 0x90) && (first != 0xF4 || second < 0x90);
  return allowed && continues(text, at + 2) && continues(text, at + 3) ? 4 : 0;
}

std::string fixed(double value, int decimals) {
  return formatted(value, std::chars_format::fixed, decimals);
}

std::string significant(double value, int digits) {
  return formatted(value, std::chars_format::general, digits);
}

}  // namespace polemcl::io
