#include "core/common/Binder.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace polemcl {
namespace {

/// Long double, because not every double of radians is the image of a double of degrees.
constexpr long double exactDegree = 3.141592653589793238462643383279502884L / 180;

/// Parses all of a text as one number in the "C" locale; empty for "3x", "1,5", "", "nan".
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

/// The shortest text that reads back as the same number.
std::string shortest(double value) {
  char buffer[64];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return error == std::errc{} ? std::string(buffer, end) : std::string();
}

double radians(long double degrees) {
  return static_cast<double>(degrees * exactDegree);
}

double degreesOf(double angle) {
  return static_cast<double>(angle / exactDegree);
}

/// The shortest text in degrees that reads back as the same radians.
std::string shortestDegrees(double angle) {
  if (!std::isfinite(angle)) return "nan";
  char buffer[64];
  std::string text;
  for (int digits = 3; digits <= 21; ++digits) {  // with 3 the largest angles need no exponent
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, angle / exactDegree,
                                            std::chars_format::general, digits);
    if (error != std::errc{}) break;
    text.assign(buffer, end);
    if (radians(parsed<long double>(text).value_or(0)) == angle) break;
  }
  return text;
}

/// Whether the angle is allowed: in degrees as computed, or as its shortest text says, since the
/// way from degrees to radians and back may miss a limit by the last bit.
bool allows(const Range& allowed, double angle) {
  if (allowed.contains(degreesOf(angle))) return true;
  const auto degrees = parsed<long double>(shortestDegrees(angle));
  return degrees && allowed.contains(static_cast<double>(*degrees));
}

/// The number that a word says, in radians where it says degrees; empty unless it is allowed.
std::optional<double> valueOf(const std::string& word, const Range& allowed, bool degrees) {
  if (degrees) {
    const auto angle = parsed<long double>(word);
    if (!angle || !allowed.contains(static_cast<double>(*angle))) return std::nullopt;
    return radians(*angle);
  }
  const auto value = parsed<double>(word);
  return value && allowed.contains(*value) ? value : std::nullopt;
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

const char* name(Tier tier) {
  static constexpr const char* names[] = {"sensor", "tuning", "expert"};
  return names[static_cast<int>(tier)];
}

void Binder::section(std::string_view name, std::string_view comment, Tier tier) {
  m_section = name;
  m_tier = tier;
  openSection(std::string(comment));
}

void Binder::bindNumbers(const Numbers& setting, std::vector<double>& field) {
  const Range& allowed = setting.allowed;
  const std::optional<std::size_t> count = setting.count;
  const bool degrees = setting.degrees;
  const auto write = [&] {
    std::string text;
    for (const double value : field)
      text += (text.empty() ? "" : " ") + (degrees ? shortestDegrees(value) : shortest(value));
    return text;
  };
  const auto allowedText = [&] { return (count == 1 ? "" : "each ") + allowed.text(); };
  const auto refused = [&](const std::string& text) {
    const std::string type = count == 1 ? "a number"
                             : count    ? std::to_string(*count) + " numbers between blanks,"
                                        : "numbers between blanks,";
    refuse(setting.key, text, type, allowedText(), setting.unit, setting.comment);
  };
  std::optional<std::string> text;
  if (!onlyChecks())
    text = exchange(known(setting.key, setting.unit, allowedText(), setting.comment), write());
  if (!text) {
    for (const double value : field)
      if (degrees ? !allows(allowed, value) : !allowed.contains(value)) refused(write());
    return;
  }
  std::vector<double> values;
  std::istringstream words(*text);
  for (std::string word; words >> word;) {
    const std::optional<double> value = valueOf(word, allowed, degrees);
    if (!value) refused(*text);
    values.push_back(*value);
  }
  if (count && values.size() != *count) refused(*text);
  field = values;
}

void Binder::number(std::string_view key, double& field, const Range& allowed,
                    std::string_view unit, std::string_view comment) {
  numbers(key, {&field}, allowed, unit, comment);
}

void Binder::integer(std::string_view key, long long& field, const Range& allowed,
                     const Range& fits, std::string_view unit, std::string_view comment) {
  const auto refused = [&](std::string_view text) {
    refuse(key, text, "a whole number", allowed.text(), unit, comment);
  };
  std::optional<std::string> text;
  if (!onlyChecks())
    text = exchange(known(key, unit, allowed.text(), comment), std::to_string(field));
  if (text) {
    const auto value = parsed<long long>(*text);
    if (!value) refused(*text);
    field = *value;
  }
  if (!fits.contains(static_cast<double>(field))) refused(text ? *text : std::to_string(field));
}

void Binder::angleDeg(std::string_view key, double& field, const Range& allowed,
                      std::string_view comment) {
  std::vector<double> angle{field};
  bindNumbers({key, "deg", comment, allowed, 1, true}, angle);
  field = angle[0];
}

void Binder::flag(std::string_view key, bool& field, std::string_view comment) {
  if (onlyChecks()) return;
  const auto text = exchange(known(key, "", "true or false", comment), field ? "true" : "false");
  if (!text) return;
  if (*text != "true" && *text != "false") refuse(key, *text, "", "true or false", "", comment);
  field = *text == "true";
}

void Binder::choice(std::string_view key, std::string& field,
                    const std::vector<std::string>& allowed, std::string_view comment) {
  const auto list = [&] {
    std::string text;
    for (const auto& word : allowed) text += (text.empty() ? "" : " | ") + word;
    return text;
  };
  if (!onlyChecks()) field = exchange(known(key, "", list(), comment), field).value_or(field);
  if (std::find(allowed.begin(), allowed.end(), field) == allowed.end())
    refuse(key, field, "one of", list(), "", comment);
}

void Binder::text(std::string_view key, std::string& field, std::string_view comment) {
  if (onlyChecks()) return;
  const auto text = exchange(known(key, "", "text", comment), field);
  if (text) field = *text;
}

void Binder::numbers(std::string_view key, std::vector<double>& field, const Range& allowed,
                     std::string_view unit, std::string_view comment) {
  bindNumbers({key, unit, comment, allowed, std::nullopt, false}, field);
}

void Binder::numbers(std::string_view key, std::initializer_list<double*> fields,
                     const Range& allowed, std::string_view unit, std::string_view comment) {
  std::vector<double> values;
  for (const double* field : fields) values.push_back(*field);
  bindNumbers({key, unit, comment, allowed, fields.size(), false}, values);
  auto value = values.begin();
  for (double* field : fields) *field = *value++;
}

void Binder::anglesDeg(std::string_view key, std::vector<double>& field, const Range& allowed,
                       std::string_view comment) {
  bindNumbers({key, "deg", comment, allowed, std::nullopt, true}, field);
}

void Binder::require(bool good, std::string_view key, double value,
                     std::string_view allowed) const {
  if (!good) require(false, key, shortest(value), allowed);
}

void Binder::require(bool good, std::string_view key, std::string_view value,
                     std::string_view allowed) const {
  if (!good) refuse(key, value, "", allowed, "", "");
}

Binder::Key Binder::known(std::string_view key, std::string_view unit, std::string allowed,
                          std::string_view comment) const {
  return {std::string(key), std::string(unit), std::move(allowed), std::string(comment), m_tier};
}

void Binder::refuse(std::string_view key, std::string_view value, std::string_view type,
                    std::string_view allowed, std::string_view unit,
                    std::string_view comment) const {
  std::string text = place() + "[" + m_section + "] ";
  text.append(key).append(" = ").append(value).append(": allowed is ");
  if (!type.empty()) text.append(type).append(" ");
  text.append(allowed);
  if (!unit.empty()) text.append(" ").append(unit);
  if (!comment.empty()) text.append(" (").append(comment).append(")");
  throw Error(text);
}

}  // namespace polemcl
