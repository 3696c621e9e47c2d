#pragma once
/// \file OusterPackets.h
/// \brief The points in the packets of an Ouster. Part of the module libpolemcl-sensors.so.

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace polemcl {

/// \brief One LiDAR, as its metadata describe it: the JSON file of Ouster's programs, or the answer
/// of the LiDAR to `http://ADDRESS/api/v1/sensor/metadata`.
///
/// Packets of firmware 1.13 and later, of all profiles with ranges, one or two returns. Formats as
/// in Ouster's sensor manual and its public SDK 1.0.
class OusterPackets {
 public:
  struct Points {
    std::vector<float> x, y, z;  ///< m
  };

  /// \throws Error when the file is no metadata of a LiDAR, or of an unknown profile.
  explicit OusterPackets(const std::string& metadataFile);

  std::size_t size() const { return m_size; }  ///< of a packet, bytes
  int port() const { return m_port; }          ///< that the LiDAR sends to; 0: not stated
  int columns() const { return m_columns; }    ///< of a turn
  int columnsPerPacket() const { return m_columnsPerPacket; }
  double turn() const { return m_turn; }  ///< duration, s
  /// \brief Whether packet `index` of a turn is sent: not if all its columns are outside the
  /// window that is set in the LiDAR.
  bool isSent(int index) const;

  /// \name Of a packet of the right size
  /// @{
  std::uint32_t turnOf(std::string_view packet) const;  ///< number of the turn
  std::uint32_t turnNumbers() const { return m_hasLongNumbers ? 0 : 65536; }  ///< 0: 2^32
  int columnOf(std::string_view packet, int i = 0) const;   ///< 0: where a turn begins
  double timeOf(std::string_view packet, int i = 0) const;  ///< by the clock of the LiDAR, s
  /// \brief Appends its returns, in the order of their columns. The second of two returns is left
  /// out if it is the same.
  ///
  /// Frame: origin in the optical centre, x opposite to the connector, z up: the axes of Ouster's
  /// sensor frame, whose origin is 36 mm lower in an OS1. A turn begins at azimuth 180 degrees,
  /// clockwise.
  void appendPoints(std::string_view packet, Points& points) const;
  /// @}

 private:
  struct Beam {
    float cosAzimuth, sinAzimuth, cosElevation, sinElevation;
  };
  void readFormat(const nlohmann::json& metadata);
  void readProfile(const nlohmann::json& metadata);
  void readBeams(const nlohmann::json& metadata);
  std::size_t columnBegin(int i) const;
  bool isValid(std::string_view packet, int i) const;
  void appendReturn(std::uint32_t millimetres, const Beam& beam, std::size_t column,
                    Points& points) const;

  int m_columns = 0, m_columnsPerPacket = 16, m_port = 0;
  int m_windowBegin = 0, m_windowEnd = 0;  ///< first and last column
  double m_turn = 0.1;
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
