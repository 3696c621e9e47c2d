#pragma once
// A street of poles as the packets of a VLP-16, byte by byte as its manual says, and a PCAP
// file of them.

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "support/PoleStreetFiles.h"

namespace testing_apps {

/// Appends a number, low byte first.
template <class Number>
void appendBytes(std::string& bytes, Number number) {
  for (std::size_t i = 0; i < sizeof number; ++i)
    bytes.push_back(static_cast<char>(static_cast<std::uint64_t>(number) >> (8 * i)));
}

/// The range of one firing in units of 2 mm; 0: nothing within 60 m.
inline std::uint16_t firingRange(double pole, double elevation) {
  const double rho = rangeOfRay(pole, std::tan(elevation));
  return rho < 60 ? static_cast<std::uint16_t>(std::lround(rho / std::cos(elevation) / 0.002)) : 0;
}

/// One turn at a pose in the map: 75 packets of 12 blocks of two firings of 16 lasers. The packets
/// show no clock, so that the turn counts as measured at one moment.
inline std::vector<std::string> turnOfVlp16(const std::vector<StreetPole>& poles, double x,
                                            double y, double yaw) {
  constexpr int elevations[] = {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
  constexpr double degree = M_PI / 180, blockAngle = 0.4;
  constexpr double firing = 55.296, laser = 2.304;  // us between two firings, and two lasers
  std::vector<std::string> packets;
  for (int block = 0; block < 900; ++block) {
    if (block % 12 == 0) packets.emplace_back();
    std::string& bytes = packets.back();
    appendBytes(bytes, std::uint16_t{0xEEFF});  // 0xFF comes first
    appendBytes(bytes, static_cast<std::uint16_t>(block * 40));
    for (int i = 0; i < 32; ++i) {
      const double turned = (i / 16 * firing + i % 16 * laser) / (2 * firing);
      const double azimuth = (block + turned) * blockAngle * degree;  // clockwise
      const double pole = rangeToPoles(poles, x, y, yaw - azimuth);
      appendBytes(bytes, firingRange(pole, elevations[i % 16] * degree));
      bytes.push_back(100);  // intensity
    }
    if (block % 12 == 11) {
      appendBytes(bytes, std::uint32_t{0});
      bytes += "\x37\x22";  // strongest return, VLP-16
    }
  }
  return packets;
}

/// Ethernet, IPv4 and UDP headers before each packet; checksums are left out, as many recorders do.
/// \param senders 0.0.0.x, in turns.
inline std::string pcapFile(const std::vector<std::string>& packets, int port,
                            const std::vector<char>& senders = {0}) {
  std::string file;
  appendBytes(file, std::uint32_t{0xA1B2C3D4});
  for (const int half : {2, 4, 0, 0, 0, 0, 0xFFFF, 0, 1, 0})
    appendBytes(file, static_cast<std::uint16_t>(half));
  for (std::size_t i = 0; i < packets.size(); ++i) {
    const std::string& packet = packets[i];
    std::string head(42, '\0');
    head[12] = 8;     // IPv4
    head[14] = 0x45;  // version, length of the header
    head[22] = 64;
    head[23] = 17;  // UDP
    head[29] = senders[i % senders.size()];
    head[36] = static_cast<char>(port >> 8);
    head[37] = static_cast<char>(port);
    const auto size = static_cast<std::uint32_t>(head.size() + packet.size());
    for (const std::uint32_t number : {0u, 0u, size, size}) appendBytes(file, number);
    file += head + packet;
  }
  return file;
}

}  // namespace testing_apps
