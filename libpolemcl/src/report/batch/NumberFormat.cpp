#include "report/batch/NumberFormat.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "io/file/TextFile.h"

namespace polemcl::report {

std::string metricText(double value, int decimals, const std::string& none) {
  if (!std::isfinite(value)) return none;
  const std::string text = io::fixed(value, decimals);
  const bool isZero = text.find_first_not_of("-0.") == std::string::npos;
  return isZero && text.front() == '-' ? text.substr(1) : text;
}

std::string percentText(double share, const std::string& none) {
  return metricText(100 * share, 1, none);
}

namespace {

constexpr double shortLength = 0.1;     // m; a column with shorter ones is shown in centimetres
constexpr double centimetreLength = 1;  // m; so are single errors below it
constexpr int decimals = 3;             // of metres and degrees
constexpr int mostDecimals = 3;         // of centimetres

/// Decimals that leave two significant digits once the value is rounded to them.
int decimalsOfTwoDigits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  const int exponent = std::atoi(std::string(text).substr(std::string(text).find('e') + 1).c_str());
  return std::clamp(1 - exponent, 0, mostDecimals);
}

std::string centimetres(double metres) {
  const double value = 100 * metres;
  const bool isShort = std::abs(metres) < shortLength;
  return metricText(value, !isShort || value == 0 ? 1 : decimalsOfTwoDigits(value));
}

}  // namespace

std::string lengthText(double metres, const std::string& space) {
  if (!std::isfinite(metres)) return enDash + space + "m";
  return std::abs(metres) < centimetreLength ? centimetres(metres) + space + "cm"
                                             : metricText(metres, decimals) + space + "m";
}

MetricColumn::MetricColumn(Quantity quantity, const std::vector<double>& values)
    : m_unit(quantity == Quantity::angle ? Unit::degree
             : std::any_of(values.begin(), values.end(),
                           [](double value) { return std::abs(value) < shortLength; })
                 ? Unit::centimetre
                 : Unit::metre) {}

std::string MetricColumn::head(const std::string& label) const {
  return label + (m_unit == Unit::degree ? " (°)" : m_unit == Unit::metre ? " (m)" : " (cm)");
}

std::string MetricColumn::latexHead(const std::string& label) const {
  return label + (m_unit == Unit::degree  ? " [$^\\circ$]"
                  : m_unit == Unit::metre ? " [m]"
                                          : " [cm]");
}

std::string MetricColumn::figure(double value, const std::string& none) const {
  if (!std::isfinite(value)) return none;
  return m_unit == Unit::centimetre ? centimetres(value) : metricText(value, decimals);
}

std::string countText(unsigned long long count) {
  std::string text = std::to_string(count);
  if (text.size() < 5) return text;
  for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, "\xE2\x80\x89");
  return text;
}

std::string plural(unsigned long long count, const std::string& word) {
  return countText(count) + ' ' + word + (count == 1 ? "" : "s");
}

std::string durationText(double seconds) {
  if (!std::isfinite(seconds)) return enDash;
  if (seconds < 9.95) return metricText(seconds, 1) + " s";
  const auto whole = static_cast<unsigned long long>(std::llround(std::max(seconds, 0.0)));
  if (whole < 60) return std::to_string(whole) + " s";
  if (whole < 3600) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole % 3600 / 60) + " min";
}

std::string sentence(const std::string& text) {
  return text.empty() || std::string(".!?").find(text.back()) != std::string::npos ? text
                                                                                   : text + '.';
}

}  // namespace polemcl::report
