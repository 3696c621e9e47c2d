#include "io/file/CsvRows.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>

#include <polemcl/core/common/Types.h>
#include "io/file/TextFile.h"

namespace polemcl::io {
namespace {

constexpr std::size_t kLinesPerReport = 10000;
constexpr std::uint64_t kMegabyte = 1000000;

}  // namespace

CsvRows::CsvRows(const std::filesystem::path& file, std::size_t columns, std::string layout,
                 ReadProgress progress)
    : m_file(file),
      m_columns(columns),
      m_layout(std::move(layout)),
      m_progress(std::move(progress)) {
  std::error_code ignored;
  // Opening a folder succeeds; only reading it fails.
  if (std::filesystem::is_directory(file, ignored))
    throw Error("cannot read " + file.string() + ": it is a folder, not a file");
  errno = 0;
  m_stream.open(file, std::ios::binary);
  if (!m_stream) throw Error("cannot read " + file.string() + ": " + std::strerror(errno));
  const auto size = std::filesystem::file_size(file, ignored);
  if (!ignored) m_size = size;
}

bool allFinite(const std::vector<double>& row) {
  return std::all_of(row.begin(), row.end(), [](double v) { return std::isfinite(v); });
}

std::string CsvRows::at() const {
  return io::at(m_file, m_line);
}

bool CsvRows::next(std::vector<double>& values) {
  values.clear();
  while (std::getline(m_stream, m_text)) {
    ++m_line;
    m_read += m_text.size() + 1;
    if (m_progress && m_line % kLinesPerReport == 0)
      m_progress(m_read / kMegabyte, m_size / kMegabyte);
    std::string_view rest = trimmed(m_text);
    if (rest.empty() || rest.front() == '#') continue;
    for (bool more = true; more;) {
      const auto comma = rest.find(',');
      const std::string_view word = trimmed(rest.substr(0, comma));
      const auto value = parseNumber(word);
      if (!value)
        throw Error(at() + "'" + std::string(word.substr(0, 40)) +
                    "' is not a number; expected: " + m_layout);
      values.push_back(*value);
      more = comma != std::string_view::npos;
      if (more) rest.remove_prefix(comma + 1);
    }
    if (values.size() != m_columns)
      throw Error(at() + std::to_string(values.size()) + " numbers, " + std::to_string(m_columns) +
                  " expected: " + m_layout);
    return true;
  }
  if (m_stream.bad()) throw Error("cannot read " + m_file.string() + " after " + at());
  return false;
}

}  // namespace polemcl::io
