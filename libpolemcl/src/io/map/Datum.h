#pragma once
/// \file Datum.h
/// \brief Position of a map on Earth, stored in the map's info under `datum`.

#include <map>
#include <optional>
#include <string>
#include <utility>

namespace polemcl::io {

/// \brief Origin of a map on WGS 84, and its rotation.
struct Datum {
  double latitude = 0;   ///< deg, north positive
  double longitude = 0;  ///< deg, east positive
  double yawDeg = 0;     ///< direction of the map's x axis, deg counter-clockwise from east
};
bool operator==(const Datum& a, const Datum& b);

/// \brief Key of the datum in the info of a map.
inline const char* const kDatumKey = "datum";

/// \brief Parses `LAT,LON` or `LAT,LON,YAW_DEG`.
/// \param where Prefix of the error message. \throws Error unless the numbers are within ±90, ±180,
///        ±360.
Datum parseDatum(const std::string& text, const std::string& where);
/// \brief Text that parseDatum() converts back to exactly the same numbers.
std::string datumText(const Datum& datum);

/// \brief The datum in a map's info; nullopt if absent. \throws Error when it is malformed.
std::optional<Datum> datumOf(const std::map<std::string, std::string>& info,
                             const std::string& where);

/// \brief Maps of different datums have different coordinates for the same place.
/// \param one, other Their infos, with the names of their files.
/// \throws Error when both have a datum and these differ.
void requireSameDatum(const std::pair<std::string, std::map<std::string, std::string>>& one,
                      const std::pair<std::string, std::map<std::string, std::string>>& other);

/// \brief Stores a datum in a map's info. \throws Error when the info holds a different datum.
void setDatum(std::map<std::string, std::string>& info, const Datum& datum,
              const std::string& where);

}  // namespace polemcl::io
