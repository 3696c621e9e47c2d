#pragma once
/// \file LidarPackets.h
/// \brief How the packets of a LiDAR that turns are read. Part of the module libpolemcl-sensors.so.

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "io/file/Bytes.h"

namespace polemcl {

/// \brief A number in a packet, low byte first. \param place Of its first byte. The packet must be
/// long enough.
template <class Number>
Number numberAt(std::string_view packet, std::size_t place) {
  return io::loadLittleEndian<Number>(packet.data() + place);
}

struct LidarPoints {
  std::vector<float> x, y, z;  ///< frame of the LiDAR, m
};

/// \brief The packets of one LiDAR. A column is what its beams measure while it faces one way.
class LidarPackets {
 public:
  /// \brief Number of a packet; the next one has the next number, and after `end` - 1 comes 0.
  struct Number {
    std::uint64_t value, end;
  };
  virtual ~LidarPackets() = default;
  virtual int usualPort() const = 0;  ///< UDP
  /// \brief Whether it is of this LiDAR, by its size. All functions below need such a packet.
  virtual bool isPacket(std::string_view packet) const = 0;
  virtual int columns(std::string_view packet) const = 0;
  /// \brief Duration of a turn, s.
  virtual double turn(std::string_view packet) const = 0;
  /// \brief None for LiDARs that do not number their packets.
  virtual std::optional<Number> number(std::string_view packet) const = 0;
  /// \brief Where in the turn column `i` is measured, 0 to below 1; none: it holds nothing.
  virtual std::optional<double> phase(std::string_view packet, int i) const = 0;
  /// \brief When column `i` is measured, by the clock of the LiDAR, s.
  virtual double time(std::string_view packet, int i) const = 0;
  /// \brief Appends the returns of column `i`. A second return is left out if it is the same.
  virtual void append(std::string_view packet, int i, LidarPoints& points) const = 0;
};

}  // namespace polemcl
