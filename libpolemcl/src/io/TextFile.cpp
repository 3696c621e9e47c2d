#include <polemcl/core/Types.h>
#include <polemcl/io/TextFile.h>
#include <zlib.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <memory>

namespace polemcl::io {

namespace {

std::string readPlainOrGzip(const std::filesystem::path& file) {
  const auto fail = [&](const std::string& why) {
    return Error("cannot read " + file.string() + ": " + why);
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) throw fail("it is a folder, not a file");
  errno = 0;
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> stream(gzopen(file.c_str(), "rb"), &gzclose);
  if (!stream) throw fail(errno != 0 ? std::strerror(errno) : "out of memory");
  std::string text;
  std::array<char, 65536> block;
  int got = 0;
  while ((got = gzread(stream.get(), block.data(), block.size())) > 0) {
    text.append(block.data(), static_cast<std::size_t>(got));
  }
  // A gzip file that is cut short reads to its end first and is reported here only.
  int code = Z_OK;
  const char* message = gzerror(stream.get(), &code);
  if (got < 0 || code != Z_OK) {
    throw fail(code == Z_ERRNO       ? std::strerror(errno)
               : code == Z_BUF_ERROR ? "the gzip data is cut short"
                                     : message);
  }
  return text;
}

}  // namespace

std::string at(const std::filesystem::path& file, std::size_t line) {
  return file.string() + ":" + std::to_string(line) + ": ";
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> readLines(const std::filesystem::path& file) {
  const std::string text = readPlainOrGzip(file);
  std::string_view rest = text;
  if (rest.substr(0, 3) == "\xEF\xBB\xBF") rest.remove_prefix(3);
  std::vector<std::string> lines;
  while (!rest.empty()) {
    const auto end = rest.find('\n');
    std::string_view line = rest.substr(0, end);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines.emplace_back(line);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
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
                                 std::size_t line) {
  std::vector<double> values;
  while (!(text = trimmed(text)).empty()) {
    const std::string_view word = text.substr(0, text.find_first_of(" \t"));
    const auto value = parseNumber(word);
    if (!value || !std::isfinite(*value)) {
      throw Error(at(file, line) + "'" + std::string(word.substr(0, 40)) + "' is no finite number");
    }
    values.push_back(*value);
    text.remove_prefix(word.size());
  }
  return values;
}

std::vector<NumberRow> readNumberRows(const std::filesystem::path& file, std::size_t columns,
                                      const std::string& layout) {
  std::vector<NumberRow> rows;
  const std::vector<std::string> lines = readLines(file);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string_view line = std::string_view(lines[i]).substr(0, lines[i].find('#'));
    if (trimmed(line).empty()) continue;
    NumberRow row{i + 1, parseNumbers(line, file, i + 1)};
    if (row.values.size() != columns) {
      throw Error(at(file, row.line) + std::to_string(row.values.size()) + " numbers, " +
                  std::to_string(columns) + " expected: " + layout);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

namespace {

std::string formatted(double value, std::chars_format format, int precision) {
  // Room for the largest double in fixed notation.
  std::array<char, 512> buffer;
  const auto result =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format, precision);
  return std::string(buffer.data(), result.ptr);
}

}  // namespace

std::string fixed(double value, int decimals) {
  return formatted(value, std::chars_format::fixed, decimals);
}

std::string significant(double value, int digits) {
  return formatted(value, std::chars_format::general, digits);
}

}  // namespace polemcl::io
