#include <algorithm>
#include <charconv>
#include <cmath>

#include "config/Config.h"
#include "io/file/TextFile.h"

namespace polemcl {
namespace {

constexpr long double degree = 3.141592653589793238462643383279502884L / 180;

/// Parses a whole text as one number in the "C" locale; nullopt for "3x", "1,5", "", "nan".
template <class Number>
std::optional<Number> parsed(const std::string& text) {
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (text.size() > 1 && *begin == '+' && text[1] != '-') ++begin;
  Number value{};
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  if constexpr (std::is_floating_point_v<Number>)
    if (!std::isfinite(value)) return std::nullopt;
  return value;
}

/// The shortest text that is read back as the same number.
std::string shortest(double value) {
  char buffer[64];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return error == std::errc{} ? std::string(buffer, end) : std::string();
}

double radians(long double degrees) {
  return static_cast<double>(degrees * degree);
}

/// The shortest text in degrees that is read back as the same radians. Long double, because some
/// doubles in radians have no double in degrees that converts to them.
std::string shortestDegrees(double angle) {
  if (!std::isfinite(angle)) return "nan";
  char buffer[64];
  std::string text;
  for (int digits = 1; digits <= 21; ++digits) {
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, angle / degree,
                                            std::chars_format::general, digits);
    if (error != std::errc{}) break;
    text.assign(buffer, end);
    if (radians(parsed<long double>(text).value_or(0)) == angle) break;
  }
  return text;
}

std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> result;
  const char* blanks = " \t";
  for (std::size_t at = text.find_first_not_of(blanks); at != std::string::npos;) {
    const std::size_t end = text.find_first_of(blanks, at);
    result.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(blanks, end);
  }
  return result;
}

template <class Values, class Format>
std::string listed(const Values& values, const Format& format) {
  std::string text;
  for (const auto& value : values) text += (text.empty() ? "" : " ") + format(value);
  return text;
}

}  // namespace

bool Range::contains(double value) const {
  return std::isfinite(value) && (openMin ? value > min : value >= min) &&
         (openMax ? value < max : value <= max);
}

std::string Range::text() const {
  const bool below = std::isfinite(max), above = std::isfinite(min);
  const std::string low = (openMin ? "> " : ">= ") + shortest(min);
  const std::string high = (openMax ? "< " : "<= ") + shortest(max);
  if (above && below) {
    if (!openMin && !openMax) return shortest(min) + " to " + shortest(max);
    return low + " and " + high;
  }
  return above ? low : below ? high : "any number";
}

void Binder::section(const std::string& name, const std::string& comment) {
  m_section = name;
  openSection(comment);
}

void Binder::number(const std::string& key, double& field, const Range& allowed,
                    const std::string& unit, const std::string& comment) {
  const Key known{key, unit, allowed.text(), comment};
  const auto text = exchange(known, shortest(field));
  if (!text) return;
  const auto value = parsed<double>(*text);
  if (!value || !allowed.contains(*value)) refuse(known, *text, "a number");
  field = *value;
}

void Binder::integer(const Key& key, long long& field, const Range& allowed) {
  const auto text = exchange(key, std::to_string(field));
  if (!text) return;
  const auto value = parsed<long long>(*text);
  if (!value || !allowed.contains(static_cast<double>(*value)))
    refuse(key, *text, "a whole number");
  field = *value;
}

void Binder::angleDeg(const std::string& key, double& field, const Range& allowed,
                      const std::string& comment) {
  const Key known{key, "deg", allowed.text(), comment};
  const auto text = exchange(known, shortestDegrees(field));
  if (!text) return;
  const auto value = parsed<long double>(*text);
  if (!value || !allowed.contains(static_cast<double>(*value))) refuse(known, *text, "a number");
  field = radians(*value);
}

void Binder::flag(const std::string& key, bool& field, const std::string& comment) {
  const Key known{key, "", "true or false", comment};
  const auto text = exchange(known, field ? "true" : "false");
  if (!text) return;
  if (*text != "true" && *text != "false") refuse(known, *text, "");
  field = *text == "true";
}

void Binder::choice(const std::string& key, std::string& field,
                    const std::vector<std::string>& allowed, const std::string& comment) {
  std::string list;
  for (const auto& word : allowed) list += (list.empty() ? "" : " | ") + word;
  const Key known{key, "", list, comment};
  // The default is checked too: its own file would otherwise be rejected on reading.
  const std::string value = exchange(known, field).value_or(field);
  if (std::find(allowed.begin(), allowed.end(), value) == allowed.end())
    refuse(known, value, "one of");
  field = value;
}

void Binder::text(const std::string& key, std::string& field, const std::string& comment) {
  const auto text = exchange({key, "", "text", comment}, field);
  if (text) field = *text;
}

void Binder::numbers(const std::string& key, std::vector<double>& field, const Range& allowed,
                     const std::string& unit, const std::string& comment) {
  const Key known{key, unit, "each " + allowed.text(), comment};
  const auto text = exchange(known, listed(field, shortest));
  if (!text) return;
  std::vector<double> values;
  for (const auto& word : words(*text)) {
    const auto value = parsed<double>(word);
    if (!value || !allowed.contains(*value)) refuse(known, *text, "numbers between blanks,");
    values.push_back(*value);
  }
  field = values;
}

void Binder::numbers(const std::string& key, std::initializer_list<double*> fields,
                     const Range& allowed, const std::string& unit, const std::string& comment) {
  const std::string type = std::to_string(fields.size()) + " numbers between blanks,";
  const Key known{key, unit, "each " + allowed.text(), comment};
  const auto text = exchange(known, listed(fields, [](double* f) { return shortest(*f); }));
  if (!text) return;
  const auto list = words(*text);
  if (list.size() != fields.size()) refuse(known, *text, type);
  std::vector<double> values;
  for (const auto& word : list) {
    const auto value = parsed<double>(word);
    if (!value || !allowed.contains(*value)) refuse(known, *text, type);
    values.push_back(*value);
  }
  auto value = values.begin();
  for (double* field : fields) *field = *value++;
}

void Binder::anglesDeg(const std::string& key, std::vector<double>& field, const Range& allowed,
                       const std::string& comment) {
  const Key known{key, "deg", "each " + allowed.text(), comment};
  const auto text = exchange(known, listed(field, shortestDegrees));
  if (!text) return;
  std::vector<double> values;
  for (const auto& word : words(*text)) {
    const auto value = parsed<long double>(word);
    if (!value || !allowed.contains(static_cast<double>(*value)))
      refuse(known, *text, "numbers between blanks,");
    values.push_back(radians(*value));
  }
  field = values;
}

void Binder::refuse(const Key& key, const std::string& value, const std::string& type) const {
  const std::string unit = key.unit.empty() ? "" : " " + key.unit;
  throw Error(place() + "[" + m_section + "] " + key.name + " = " + value + ": allowed is " +
              (type.empty() ? "" : type + " ") + key.allowed + unit + " (" + key.comment + ")");
}

void Binder::refuseStruct(const std::string& what) const {
  const bool named = !what.empty() && what.front() == '[';  // already names its section
  throw Error(place() + (named ? "" : "[" + m_section + "] ") + what);
}

}  // namespace polemcl
