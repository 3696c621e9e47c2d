#include "mrpt/live/HesaiPackets.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iterator>
#include <sstream>

#include <polemcl/core/common/Types.h>
#include "io/file/InputFile.h"

namespace polemcl {

/// Places are in bytes; those of the tail are counted from the end of the blocks.
struct HesaiPackets::Format {
  std::size_t channels, blocks;
  std::size_t header, unitPlace;   ///< unitPlace: of the unit of distances, mm; 0: 4 mm
  std::size_t mark, pixel;         ///< bytes before the azimuth of a block, and of a return
  std::size_t speed, clock, date;  ///< in the tail: turns a minute, us, year to second
  std::size_t tail;                ///< bytes
  bool isNumbered;                 ///< four more bytes

  std::size_t blockSize() const { return mark + 2 + channels * pixel; }
  std::size_t tailBegin() const { return header + blocks * blockSize(); }
  std::size_t size() const { return tailBegin() + tail + (isNumbered ? 4 : 0); }
};

namespace {

constexpr double kFullTurn = 36000;  // hundredths of a degree
constexpr std::uint16_t kPacketMark = 0xFFEE, kBlockMark = 0xEEFF;

std::vector<double> numbersIn(std::string row) {
  std::replace(row.begin(), row.end(), ',', ' ');
  std::istringstream in(row);
  return {std::istream_iterator<double>(in), {}};
}

}  // namespace

HesaiPackets::HesaiPackets(const std::string& calibrationFile) {
  const auto refuse = [&](const std::string& why) {
    throw Error(calibrationFile + ": is no table of the angles of a Hesai: " + why);
  };
  if (const char* why = io::whyNoInput(calibrationFile))
    throw Error(calibrationFile + ": cannot be read: " + why);
  std::ifstream in(calibrationFile);
  if (!in) throw Error(calibrationFile + ": cannot be read");
  for (std::string row; std::getline(in, row);) {
    const auto numbers = numbersIn(row);
    if (numbers.empty() && m_channels.empty()) continue;  // names of the columns
    if (numbers.empty()) break;
    const std::string place = "row " + std::to_string(m_channels.size() + 1);
    if (numbers.size() != 3 || numbers[0] != static_cast<double>(m_channels.size() + 1))
      refuse(place + " is not its number, elevation, azimuth");
    if (!(std::abs(numbers[1]) <= 90 && std::abs(numbers[2]) <= 90))
      refuse(place + " has angles beyond 90 degrees");
    const double elevation = numbers[1] * M_PI / 180;
    m_channels.push_back({numbers[2] * M_PI / 180, static_cast<float>(std::cos(elevation)),
                          static_cast<float>(std::sin(elevation))});
  }
  const std::size_t count = m_channels.size();
  if (count != 16 && count != 32 && count != 40 && count != 64)
    refuse(std::to_string(count) + " channels; allowed are 16, 32, 40 and 64");
}

const HesaiPackets::Format* HesaiPackets::formatOf(std::string_view packet) const {
  static constexpr Format formats[] = {
      {16, 8, 12, 9, 0, 4, 11, 19, 13, 24, true},  // PandarXT16
      {32, 8, 12, 9, 0, 4, 11, 19, 13, 24, true},  // PandarXT32
      {32, 6, 12, 9, 0, 4, 11, 19, 13, 24, true},  // PandarXT32M
      {64, 4, 12, 9, 0, 4, 10, 12, 18, 24, true},  // PandarQT64
      {64, 6, 8, 5, 0, 3, 8, 10, 16, 22, false},   // Pandar64
      {64, 6, 8, 5, 0, 3, 8, 10, 16, 22, true},    // the same, numbered
      {40, 10, 0, 0, 2, 3, 8, 10, 16, 22, false},  // Pandar40P
      {40, 10, 0, 0, 2, 3, 8, 10, 16, 22, true}};  // the same, numbered
  const auto* found = std::find_if(std::begin(formats), std::end(formats), [&](const Format& one) {
    return one.size() == packet.size() && one.channels == m_channels.size();
  });
  return found == std::end(formats) ? nullptr : found;
}

bool HesaiPackets::isPacket(std::string_view packet) const {
  const Format* format = formatOf(packet);
  return format &&
         numberAt<std::uint16_t>(packet, 0) == (format->header > 0 ? kPacketMark : kBlockMark);
}

int HesaiPackets::columns(std::string_view packet) const {
  return static_cast<int>(formatOf(packet)->blocks);
}

double HesaiPackets::turn(std::string_view packet) const {
  const Format& format = *formatOf(packet);
  const int perMinute = numberAt<std::uint16_t>(packet, format.tailBegin() + format.speed);
  return 60.0 / std::clamp(perMinute, 60, 6000);
}

std::optional<LidarPackets::Number> HesaiPackets::number(std::string_view packet) const {
  if (!formatOf(packet)->isNumbered) return std::nullopt;
  return Number{numberAt<std::uint32_t>(packet, packet.size() - 4), std::uint64_t{1} << 32};
}

std::optional<double> HesaiPackets::phase(std::string_view packet, int i) const {
  const Format& format = *formatOf(packet);
  const std::size_t begin = format.header + static_cast<std::size_t>(i) * format.blockSize();
  const double azimuth = numberAt<std::uint16_t>(packet, begin + format.mark);
  if (azimuth >= kFullTurn) return std::nullopt;
  return azimuth / kFullTurn;
}

/// The clock is that of the end of the packet.
double HesaiPackets::time(std::string_view packet, int i) const {
  const Format& format = *formatOf(packet);
  const auto at = [&](std::size_t place) {
    return static_cast<unsigned char>(packet[format.tailBegin() + format.date + place]);
  };
  std::tm date{};
  date.tm_year = at(0) < 70 ? at(0) + 100 : at(0);  // some count from 2000, some from 1900
  date.tm_mon = at(1) - 1;
  date.tm_mday = at(2);
  date.tm_hour = at(3);
  date.tm_min = at(4);
  date.tm_sec = at(5);
  const double end = static_cast<double>(timegm(&date)) +
                     1e-6 * numberAt<std::uint32_t>(packet, format.tailBegin() + format.clock);
  const auto here = phase(packet, i), last = phase(packet, columns(packet) - 1);
  if (!here || !last) return end;
  return end - std::fmod(*last - *here + 1, 1.0) * turn(packet);
}

void HesaiPackets::append(std::string_view packet, int i, LidarPoints& points) const {
  const Format& format = *formatOf(packet);
  const std::size_t begin = format.header + static_cast<std::size_t>(i) * format.blockSize();
  const int azimuth = numberAt<std::uint16_t>(packet, begin + format.mark);
  // A LiDAR that gives two returns sends two blocks with the same azimuth.
  const bool isSecond =
      i > 0 && numberAt<std::uint16_t>(packet, begin - format.blockSize() + format.mark) == azimuth;
  const double unit =
      format.unitPlace == 0 ? 4 : static_cast<unsigned char>(packet[format.unitPlace]);
  for (std::size_t k = 0; k < m_channels.size(); ++k) {
    const std::size_t place = begin + format.mark + 2 + k * format.pixel;
    const int range = numberAt<std::uint16_t>(packet, place);
    if (range == 0 ||
        (isSecond && range == numberAt<std::uint16_t>(packet, place - format.blockSize())))
      continue;
    const Channel& channel = m_channels[k];
    const double angle = azimuth * 2 * M_PI / kFullTurn + channel.azimuth;
    const auto metres = static_cast<float>(range * unit / 1000);
    points.x.push_back(metres * channel.cosElevation * static_cast<float>(std::sin(angle)));
    points.y.push_back(metres * channel.cosElevation * static_cast<float>(std::cos(angle)));
    points.z.push_back(metres * channel.sinElevation);
  }
}

}  // namespace polemcl
