#pragma once
/// \file HesaiPackets.h
/// \brief The packets of a Hesai. Part of the module libpolemcl-sensors.so.

#include <string>

#include "mrpt/live/LidarPackets.h"

namespace polemcl {

/// \brief Packets of Pandar40P, Pandar64, PandarQT64, PandarXT16, XT32 and XT32M; their size tells
/// which. Formats as in Hesai's manuals.
///
/// The calibration is a CSV file with a row for each channel: number, elevation and azimuth in
/// degrees; the LiDAR and Hesai's programs give it. Frame of the points: that of Hesai's manuals, y
/// at azimuth 0, azimuths clockwise, z up. A turn begins at azimuth 0, which is 90 degrees
/// (`[sensor] cut_deg`).
class HesaiPackets : public LidarPackets {
 public:
  /// \throws Error when the file is no such table.
  explicit HesaiPackets(const std::string& calibrationFile);

  int usualPort() const override { return 2368; }
  bool isPacket(std::string_view packet) const override;
  int columns(std::string_view packet) const override;
  double turn(std::string_view packet) const override;
  std::optional<Number> number(std::string_view packet) const override;
  std::optional<double> phase(std::string_view packet, int i) const override;
  /// \brief UTC as the LiDAR has it.
  double time(std::string_view packet, int i) const override;
  void append(std::string_view packet, int i, LidarPoints& points) const override;

 private:
  struct Channel {
    double azimuth;  ///< rad
    float cosElevation, sinElevation;
  };
  struct Format;
  const Format* formatOf(std::string_view packet) const;

  std::vector<Channel> m_channels;
};

}  // namespace polemcl
