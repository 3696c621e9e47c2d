#pragma once
/// \file OusterPackets.h
/// \brief The packets of an Ouster. Part of the module libpolemcl-sensors.so.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "mrpt/live/LidarPackets.h"

namespace polemcl {

/// \brief One LiDAR, as its metadata describe it: the JSON file of Ouster's programs, or the answer
/// of the LiDAR to `http://ADDRESS/api/v1/sensor/metadata`.
///
/// Packets of firmware 1.13 and later, of all profiles with ranges but those with colours, one or
/// two returns. Formats as in Ouster's sensor manual and its public SDK 1.0.
///
/// Frame of the points: origin in the optical centre, x opposite to the connector, z up: the axes
/// of Ouster's sensor frame, whose origin is 36 mm lower in an OS1. A turn begins at azimuth 180
/// degrees, clockwise.
class OusterPackets : public LidarPackets {
 public:
  /// \throws Error when the file is no metadata of a LiDAR, or of an unknown profile.
  explicit OusterPackets(const std::string& metadataFile);

  std::size_t size() const { return m_size; }  ///< of a packet, bytes

  int usualPort() const override { return m_port; }
  bool isPacket(std::string_view packet) const override { return packet.size() == m_size; }
  int columns(std::string_view) const override { return m_columnsPerPacket; }
  double turn(std::string_view) const override { return m_turn; }
  /// \brief Packets outside the window that is set in the LiDAR are not sent, and not counted.
  std::optional<Number> number(std::string_view packet) const override;
  std::optional<double> phase(std::string_view packet, int i) const override;
  double time(std::string_view packet, int i) const override;
  void append(std::string_view packet, int i, LidarPoints& points) const override;

 private:
  struct Beam {
    float cosAzimuth, sinAzimuth, cosElevation, sinElevation;
  };
  void readFormat(const nlohmann::json& metadata);
  void readProfile(const nlohmann::json& metadata);
  void readBeams(const nlohmann::json& metadata);
  std::size_t columnBegin(int i) const;
  int indexOf(std::string_view packet, int i) const;
  bool isValid(std::string_view packet, int i) const;
  bool isSent(int packet) const;
  void appendReturn(std::uint32_t millimetres, const Beam& beam, std::size_t column,
                    LidarPoints& points) const;

  int m_columns = 0, m_columnsPerPacket = 16, m_port = 7502;
  int m_windowBegin = 0, m_windowEnd = 0;  ///< first and last column
  std::vector<int> m_sentBefore;           ///< packets of a turn before each one, and in all
  double m_turn = 0.1;                     ///< s
  bool m_isLegacy = false, m_hasLongNumbers = false;
  std::size_t m_pixelSize = 0, m_columnSize = 0, m_size = 0;  ///< bytes
  std::uint32_t m_rangeMask = 0;
  int m_rangeShift = 0;  ///< to the left
  bool m_isDual = false;
  float m_origin = 0;  ///< distance of the beams' origins from the axis, m
  std::vector<Beam> m_beams;
  std::vector<float> m_cosines, m_sines;  ///< of the columns, frame of the points
};

}  // namespace polemcl
