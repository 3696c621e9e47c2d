#include "FigureText.h"

#include <polemcl/io/TextFile.h>

#include <cmath>

namespace polemcl::report {

std::string figureText(double value, int decimals, const std::string& none) {
  if (!std::isfinite(value)) return none;
  const std::string text = io::fixed(value, decimals);
  const bool isZero = text.find_first_not_of("-0.") == std::string::npos;
  return isZero && text.front() == '-' ? text.substr(1) : text;
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
  if (seconds < 9.95) return figureText(seconds, 1) + " s";
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
