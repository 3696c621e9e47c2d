#pragma once
// A street of poles as the packets of an Ouster, byte by byte as its manual says, and the
// metadata of that LiDAR.

#include "support/VelodynePackets.h"

namespace testing_apps {

/// 32 rings, 1024 columns, 16 columns a packet; the origin of the beams 15.8 mm from the axis.
struct OusterModel {
  std::string profile = "RNG19_RFL8_SIG16_NIR16";
  static constexpr int rings = 32, columns = 1024;
  static constexpr double origin = 0.0158;  ///< m

  static double elevation(int ring) { return 16.6 - ring * 33.2 / 31; }   ///< degrees
  static double azimuth(int ring) { return ring % 2 == 0 ? 2.1 : -2.1; }  ///< degrees, clockwise
  bool isDual() const { return profile.find("DUAL") != std::string::npos; }
  std::string metadata(const std::string& more = "") const {
    std::string elevations, azimuths;
    for (int i = 0; i < rings; ++i) {
      elevations += (i > 0 ? "," : "") + std::to_string(elevation(i));
      azimuths += (i > 0 ? "," : "") + std::to_string(azimuth(i));
    }
    return R"({"beam_intrinsics":{"beam_altitude_angles":[)" + elevations +
           R"(],"beam_azimuth_angles":[)" + azimuths +
           R"(],"lidar_origin_to_beam_origin_mm":15.8},"config_params":{"lidar_mode":"1024x10")" +
           R"(},"lidar_data_format":{"columns_per_frame":1024,"columns_per_packet":16,)" +
           R"("pixels_per_column":32,"udp_profile_lidar":")" + profile + "\"" + more + "}}";
  }
};

/// The range of one beam, mm; 0: nothing within 60 m.
inline std::uint32_t ousterRange(const std::vector<StreetPole>& poles, double x, double y,
                                 double yaw, double encoder, int ring) {
  constexpr double degree = M_PI / 180;
  const double azimuth = yaw + encoder - OusterModel::azimuth(ring) * degree,
               slope = std::tan(OusterModel::elevation(ring) * degree),
               cosine = std::cos(OusterModel::elevation(ring) * degree);
  const double fromX = x + OusterModel::origin * std::cos(yaw + encoder),
               fromY = y + OusterModel::origin * std::sin(yaw + encoder);
  const double level = rangeOfRay(rangeToPoles(poles, fromX, fromY, azimuth), slope);
  return level < 60 ? static_cast<std::uint32_t>(
                          std::lround((level / cosine + OusterModel::origin) * 1000))
                    : 0;
}

/// One turn at a pose in the map: 64 packets. \param number Of the turn. \param begin Clock of the
/// LiDAR at column 0, ns.
inline std::vector<std::string> turnOfOuster(const OusterModel& model, double x, double y,
                                             double yaw, int number, std::uint64_t begin) {
  constexpr std::uint64_t step = 100'000'000 / OusterModel::columns;  // ns
  const bool isLegacy = model.profile == "LEGACY";
  const auto poles = streetPoles();
  std::vector<std::string> packets;
  for (int column = 0; column < OusterModel::columns; ++column) {
    if (column % 16 == 0) {
      packets.emplace_back(isLegacy ? 0 : 32, '\0');
      if (!isLegacy) {
        packets.back()[0] = 1;  // ranges
        packets.back()[2] = static_cast<char>(number);
        packets.back()[3] = static_cast<char>(number >> 8);
      }
    }
    std::string& bytes = packets.back();
    appendBytes(bytes, begin + static_cast<std::uint64_t>(column) * step);
    appendBytes(bytes, static_cast<std::uint16_t>(column));
    appendBytes(bytes, static_cast<std::uint16_t>(isLegacy ? number : 1));  // 1: valid
    if (isLegacy) appendBytes(bytes, static_cast<std::uint32_t>(column * 88));
    for (int ring = 0; ring < OusterModel::rings; ++ring) {
      const double encoder = M_PI - 2 * M_PI * column / OusterModel::columns;
      const std::uint32_t range = ousterRange(poles, x, y, yaw, encoder, ring);
      appendBytes(bytes, range | 0xA8000000u);  // with flags and reflectivity in the high bits
      if (model.isDual()) appendBytes(bytes, (range > 0 ? range + 500 : 0) | 0xA8000000u);
      bytes += std::string(8, '\x7f');
    }
    if (isLegacy) appendBytes(bytes, std::uint32_t{0xFFFFFFFF});
    if (!isLegacy && column % 16 == 15) bytes += std::string(32, '\0');
  }
  return packets;
}

}  // namespace testing_apps
