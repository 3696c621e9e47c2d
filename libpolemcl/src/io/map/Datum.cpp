#include "io/map/Datum.h"

#include <charconv>
#include <cmath>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "io/file/TextFile.h"

namespace polemcl::io {
namespace {

/// Shortest text that converts back to exactly the same number.
std::string exact(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

}  // namespace

bool operator==(const Datum& a, const Datum& b) {
  return a.latitude == b.latitude && a.longitude == b.longitude && a.yawDeg == b.yawDeg;
}

Datum parseDatum(const std::string& text, const std::string& where) {
  std::vector<double> values;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const auto value = parseNumber(text.substr(begin, end - begin));
    values.push_back(value ? *value : NAN);
    begin = end + 1;
  }
  if (values.size() == 2) values.push_back(0);
  const bool good = values.size() == 3 && std::abs(values[0]) <= 90 && std::abs(values[1]) <= 180 &&
                    std::abs(values[2]) <= 360;
  if (!good)
    throw Error(
        where + "'" + text +
        "' is not a datum; write LAT,LON or LAT,LON,YAW_DEG in degrees, within 90, 180 and 360");
  return {values[0], values[1], values[2]};
}

std::string datumText(const Datum& datum) {
  return exact(datum.latitude) + ',' + exact(datum.longitude) + ',' + exact(datum.yawDeg);
}

std::optional<Datum> datumOf(const std::map<std::string, std::string>& info,
                             const std::string& where) {
  const auto found = info.find(kDatumKey);
  if (found == info.end()) return std::nullopt;
  return parseDatum(found->second, where);
}

void requireSameDatum(const std::pair<std::string, std::map<std::string, std::string>>& one,
                      const std::pair<std::string, std::map<std::string, std::string>>& other) {
  const auto first = datumOf(one.second, one.first + ": "),
             second = datumOf(other.second, other.first + ": ");
  if (!first || !second || *first == *second) return;
  throw Error(other.first + ": its datum is " + datumText(*second) + ", but that of " + one.first +
              " is " + datumText(*first) +
              "; maps are compared in one frame: pole-map convert writes one as GeoJSON, pole-map "
              "import --datum brings that to the datum of the other");
}

void setDatum(std::map<std::string, std::string>& info, const Datum& datum,
              const std::string& where) {
  const auto before = datumOf(info, where);
  if (before && !(*before == datum))
    throw Error(where + "its datum is " + datumText(*before) + ", not " + datumText(datum) +
                "; poses of another datum do not fit this map");
  info[kDatumKey] = datumText(datum);
}

}  // namespace polemcl::io
