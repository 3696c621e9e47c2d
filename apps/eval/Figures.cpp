#include "eval/Figures.h"

#include <algorithm>
#include <cstdlib>

#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

/// \param format Behind the colon: `[COLUMNS.]DECIMALS[*FACTOR]`, or empty.
std::string shown(const Json& value, const std::string& format) {
  const std::size_t times = format.find('*'), dot = format.substr(0, times).find('.');
  const double factor = times == std::string::npos ? 1 : std::atof(format.c_str() + times + 1);
  const std::size_t columns = dot == std::string::npos ? 0 : std::strtoul(format.c_str(), {}, 10);
  const int decimals = std::atoi(format.c_str() + (dot == std::string::npos ? 0 : dot + 1));
  std::string text = "-";
  if (value.is_string())
    text = value.get<std::string>();
  else if (value.is_number() && !format.empty())
    text = io::fixed(factor * value.get<double>(), decimals);
  else if (!value.is_null())
    text = value.dump();
  return std::string(columns - std::min(columns, text.size()), ' ') + text;
}

}  // namespace

std::string filled(const std::string& text, const Json& json) {
  std::string result;
  std::size_t at = 0;
  for (std::size_t open; (open = text.find('{', at)) != std::string::npos;) {
    const std::size_t close = text.find('}', open);
    const std::string figure = text.substr(open + 1, close - open - 1);
    const std::size_t colon = std::min(figure.find(':'), figure.size());
    result +=
        text.substr(at, open - at) + shown(json.at(figure.substr(0, colon)),
                                           colon < figure.size() ? figure.substr(colon + 1) : "");
    at = close + 1;
  }
  return result + text.substr(at);
}

}  // namespace polemcl::apps
