#pragma once
/// \file Datum.h
/// \brief Where on Earth a map lies: what is written in its info under `datum`.

#include <map>
#include <optional>
#include <string>

namespace polemcl::io {

/// \brief The origin of a map, on WGS 84, and how it is turned.
struct Datum {
  double latitude = 0;   ///< deg, north positive
  double longitude = 0;  ///< deg, east positive
  double yawDeg = 0;     ///< the map's x axis, deg counter-clockwise from east
};
bool operator==(const Datum& a, const Datum& b);

/// \brief Key of a datum in the info of a map.
inline const char* const kDatumKey = "datum";

/// \brief `LAT,LON` or `LAT,LON,YAW_DEG`.
/// \param where Start of the message. \throws Error unless the numbers are within ±90, ±180, ±360.
Datum parseDatum(const std::string& text, const std::string& where);
/// \brief As parseDatum() takes it; the same numbers to the last bit.
std::string datumText(const Datum& datum);

/// \brief The datum in a map's info, if there is one. \throws Error when it is none.
std::optional<Datum> datumOf(const std::map<std::string, std::string>& info,
                             const std::string& where);

/// \brief Puts a datum into a map's info. \throws Error when another one stands there.
void setDatum(std::map<std::string, std::string>& info, const Datum& datum,
              const std::string& where);

}  // namespace polemcl::io
