#include "io/file/Date.h"

#include <array>
#include <cmath>
#include <ctime>

#include <polemcl/core/common/Types.h>

namespace polemcl::io {

std::string dateText(double seconds) {
  constexpr double kLatest = 253402300800;  // the year 10000
  if (!(seconds > 0 && seconds < kLatest)) return "";
  const auto time = static_cast<std::time_t>(std::floor(seconds));
  std::tm parts{};
  ::gmtime_r(&time, &parts);
  std::array<char, 16> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d", &parts);
  return text.data();
}

double secondsOfDate(const std::string& text) {
  std::tm parts{};
  const char* end = text.size() == 10 ? ::strptime(text.c_str(), "%Y-%m-%d", &parts) : nullptr;
  const double seconds = end && *end == '\0' ? static_cast<double>(::timegm(&parts)) : -1;
  // Convert back: a day that does not exist (2012-02-30) comes back as another one.
  const bool exists = seconds == 0 || (seconds > 0 && dateText(seconds) == text);
  if (!exists) throw Error("'" + text + "' is not a date; write YYYY-MM-DD, from 1970-01-01 on");
  return seconds;
}

}  // namespace polemcl::io
