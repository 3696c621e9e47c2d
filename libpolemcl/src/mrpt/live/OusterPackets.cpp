#include "mrpt/live/OusterPackets.h"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include <polemcl/core/common/Types.h>
#include "io/file/InputFile.h"
#include "io/file/ParsedJson.h"

namespace polemcl {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kHeader = 32, kFooter = 32;  // bytes of a packet
constexpr int kMostColumns = 8192, kMostRows = 512;
constexpr std::size_t kMostBytes = 65507;

/// How the ranges of a pixel are written, low byte first.
struct Profile {
  std::size_t bytes;  ///< of a pixel
  int rangeBits, rangeShift;
  bool isDual = false;  ///< the second range is four bytes later
};

const std::map<std::string, Profile>& profiles() {
  static const std::map<std::string, Profile> all{
      {"LEGACY", {12, 20, 0}},
      {"RNG19_RFL8_SIG16_NIR16", {12, 19, 0}},
      {"RNG19_RFL8_SIG16_NIR16_ZONE16", {12, 19, 0}},
      {"RNG19_RFL8_SIG16_NIR16_DUAL", {16, 19, 0, true}},
      {"RNG19_RFL8_SIG16_ZONE16_DUAL", {16, 19, 0, true}},
      {"FIVE_WORD_PIXEL", {20, 19, 0, true}},
      {"RNG15_RFL8_NIR8", {4, 15, 3}},
      {"RNG15_RFL8_WIN8", {4, 15, 3}},
      {"RNG15_RFL8_NIR8_ZONE16", {8, 15, 3}},
      {"RNG15_RFL8_NIR8_DUAL", {8, 15, 3, true}},
      {"FUSA_RNG15_RFL8_NIR8_DUAL", {8, 15, 3, true}}};
  return all;
}

/// The file is no metadata, for this reason.
[[noreturn]] void refuse(const std::string& why) {
  throw std::invalid_argument(why);
}

/// The first of these that is in the file; firmware 3 has the values in groups.
const Json& valueOf(const Json& all, const std::vector<std::string>& pointers) {
  static const Json none;
  for (const std::string& pointer : pointers) {
    const Json::json_pointer place(pointer);
    if (all.contains(place)) return all.at(place);
  }
  return none;
}

std::vector<std::string> inFormat(const std::string& name) {
  return {"/data_format/" + name, "/lidar_data_format/" + name};
}

int wholeNumber(const Json& all, const std::vector<std::string>& pointers, int usual, int most) {
  const Json& value = valueOf(all, pointers);
  if (value.is_null()) return usual;
  const double number = value.get<double>();
  if (!(number >= 0 && number <= most) || number != std::floor(number))
    refuse(pointers.front().substr(1) + " is not 0 to " + std::to_string(most));
  return static_cast<int>(number);
}

std::vector<double> angles(const Json& all, const std::string& name) {
  const auto degrees =
      valueOf(all, {"/" + name, "/beam_intrinsics/" + name}).get<std::vector<double>>();
  if (degrees.empty() || degrees.size() > kMostRows)
    refuse(name + ": allowed are 1 to " + std::to_string(kMostRows) + " beams");
  std::vector<double> radians;
  for (const double degree : degrees) {
    if (!(std::abs(degree) <= 360)) refuse(name + ": are not -360 to 360 degrees");
    radians.push_back(degree * M_PI / 180);
  }
  return radians;
}

/// Columns and turns a second: 1024x10.
std::pair<int, double> modeOf(const Json& all) {
  const auto text = valueOf(all, {"/lidar_mode", "/config_params/lidar_mode"}).get<std::string>();
  int columns = 0, rate = 0;
  if (std::sscanf(text.c_str(), "%5dx%4d", &columns, &rate) != 2 || columns < 1 ||
      columns > kMostColumns || rate < 1)
    refuse("lidar_mode is no columns x turns a second, such as 1024x10");
  return {columns, 1.0 / rate};
}

}  // namespace

OusterPackets::OusterPackets(const std::string& metadataFile) {
  try {
    if (const char* why = io::whyNoInput(metadataFile))
      throw Error(metadataFile + ": cannot be read: " + why);
    std::ifstream in(metadataFile);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    if (!in) throw Error(metadataFile + ": cannot be read");
    const auto metadata = io::parsedJsonText<Json>(text, metadataFile);
    readFormat(metadata);
    readProfile(metadata);
    readBeams(metadata);
  } catch (const Json::exception& error) {
    throw Error(metadataFile + ": is no metadata of an Ouster: " + error.what());
  } catch (const std::invalid_argument& error) {
    throw Error(metadataFile + ": is no metadata of an Ouster: " + error.what());
  }
}

void OusterPackets::readFormat(const Json& metadata) {
  const auto [columns, turn] = modeOf(metadata);
  m_turn = turn;
  m_columns = wholeNumber(metadata, inFormat("columns_per_frame"), columns, kMostColumns);
  m_columnsPerPacket = wholeNumber(metadata, inFormat("columns_per_packet"), 16, kMostColumns);
  m_port =
      wholeNumber(metadata, {"/udp_port_lidar", "/config_params/udp_port_lidar"}, m_port, 65535);
  if (m_columns < 1 || m_columnsPerPacket < 1) refuse("it has no columns");
  m_windowEnd = m_columns - 1;
  const Json& window = valueOf(metadata, inFormat("column_window"));
  if (!window.is_null()) {
    m_windowBegin = window.at(0).get<int>();
    m_windowEnd = window.at(1).get<int>();
  }
  m_sentBefore = {0};
  for (int i = 0; i * m_columnsPerPacket < m_columns; ++i)
    m_sentBefore.push_back(m_sentBefore.back() + (isSent(i) ? 1 : 0));
  if (m_sentBefore.back() == 0) refuse("its column_window has no column");
}

void OusterPackets::readProfile(const Json& metadata) {
  const Json &stated = valueOf(metadata, inFormat("udp_profile_lidar")),
             &header = valueOf(metadata, inFormat("header_type"));
  const std::string name = stated.is_null() ? "LEGACY" : stated.get<std::string>();
  const auto known = profiles().find(name);
  if (known == profiles().end()) refuse("udp_profile_lidar " + name + " is not known");
  const Profile& profile = known->second;
  m_isLegacy = name == "LEGACY";
  m_hasLongNumbers =
      name.rfind("FUSA", 0) == 0 || (!m_isLegacy && header.is_string() && header == "FUSA");
  m_pixelSize = profile.bytes;
  m_rangeMask = (1u << profile.rangeBits) - 1;
  m_rangeShift = profile.rangeShift;
  m_isDual = profile.isDual;
}

void OusterPackets::readBeams(const Json& metadata) {
  const auto elevations = angles(metadata, "beam_altitude_angles"),
             azimuths = angles(metadata, "beam_azimuth_angles");
  const int rows = static_cast<int>(elevations.size());
  if (elevations.size() != azimuths.size() ||
      rows != wholeNumber(metadata, inFormat("pixels_per_column"), rows, kMostRows))
    refuse("numbers of elevations, azimuths and pixels_per_column differ");
  for (std::size_t i = 0; i < elevations.size(); ++i)  // azimuths are clockwise
    m_beams.push_back(
        {static_cast<float>(std::cos(azimuths[i])), static_cast<float>(-std::sin(azimuths[i])),
         static_cast<float>(std::cos(elevations[i])), static_cast<float>(std::sin(elevations[i]))});
  const std::string name = "/lidar_origin_to_beam_origin_mm";
  const Json& origin = valueOf(metadata, {name, "/beam_intrinsics" + name});
  m_origin = origin.is_null() ? 0 : origin.get<float>() / 1000;
  if (!(std::abs(m_origin) < 1)) refuse("lidar_origin_to_beam_origin_mm is not below 1 m");
  for (int i = 0; i < m_columns; ++i) {
    const double azimuth = M_PI - 2 * M_PI * i / m_columns;
    m_cosines.push_back(static_cast<float>(std::cos(azimuth)));
    m_sines.push_back(static_cast<float>(std::sin(azimuth)));
  }
  m_columnSize = (m_isLegacy ? 20 : 12) + m_beams.size() * m_pixelSize;
  m_size = static_cast<std::size_t>(m_columnsPerPacket) * m_columnSize +
           (m_isLegacy ? 0 : kHeader + kFooter);
  if (m_size > kMostBytes) refuse("its packets are longer than UDP allows");
}

bool OusterPackets::isSent(int packet) const {
  const int first = packet * m_columnsPerPacket, last = first + m_columnsPerPacket - 1;
  if (m_windowBegin <= m_windowEnd) return first <= m_windowEnd && last >= m_windowBegin;
  return first <= m_windowEnd || last >= m_windowBegin;
}

std::size_t OusterPackets::columnBegin(int i) const {
  return (m_isLegacy ? 0 : kHeader) + static_cast<std::size_t>(i) * m_columnSize;
}

int OusterPackets::indexOf(std::string_view packet, int i) const {
  return numberAt<std::uint16_t>(packet, columnBegin(i) + 8);
}

std::optional<LidarPackets::Number> OusterPackets::number(std::string_view packet) const {
  const std::uint64_t turn = m_hasLongNumbers
                                 ? numberAt<std::uint32_t>(packet, 4)
                                 : numberAt<std::uint16_t>(packet, m_isLegacy ? 10 : 2);
  const std::uint64_t turns = m_hasLongNumbers ? std::uint64_t{1} << 32 : 1 << 16;
  const auto place = static_cast<std::size_t>(indexOf(packet, 0) / m_columnsPerPacket);
  if (place + 1 >= m_sentBefore.size()) return std::nullopt;
  const auto perTurn = static_cast<std::uint64_t>(m_sentBefore.back());
  return Number{turn * perTurn + static_cast<std::uint64_t>(m_sentBefore[place]), turns * perTurn};
}

bool OusterPackets::isValid(std::string_view packet, int i) const {
  if (indexOf(packet, i) >= m_columns) return false;
  if (m_isLegacy) return numberAt<std::uint32_t>(packet, columnBegin(i + 1) - 4) == 0xFFFFFFFF;
  return (numberAt<std::uint16_t>(packet, columnBegin(i) + 10) & 1) != 0;
}

std::optional<double> OusterPackets::phase(std::string_view packet, int i) const {
  if (!isValid(packet, i)) return std::nullopt;
  return static_cast<double>(indexOf(packet, i)) / m_columns;
}

double OusterPackets::time(std::string_view packet, int i) const {
  return static_cast<double>(numberAt<std::uint64_t>(packet, columnBegin(i))) * 1e-9;
}

void OusterPackets::append(std::string_view packet, int i, LidarPoints& points) const {
  const auto column = static_cast<std::size_t>(indexOf(packet, i));
  std::size_t place = columnBegin(i) + (m_isLegacy ? 16 : 12);
  for (const Beam& beam : m_beams) {
    const auto rangeAt = [&](std::size_t at) {
      return (numberAt<std::uint32_t>(packet, at) & m_rangeMask) << m_rangeShift;
    };
    const std::uint32_t first = rangeAt(place), second = m_isDual ? rangeAt(place + 4) : 0;
    appendReturn(first, beam, column, points);
    if (second != first) appendReturn(second, beam, column, points);
    place += m_pixelSize;
  }
}

void OusterPackets::appendReturn(std::uint32_t millimetres, const Beam& beam, std::size_t column,
                                 LidarPoints& points) const {
  if (millimetres == 0) return;
  const float beyond = static_cast<float>(millimetres) * 1e-3f - m_origin;  // the beam's origin
  const float cosine = m_cosines[column], sine = m_sines[column],
              level = beyond * beam.cosElevation;
  points.x.push_back(level * (cosine * beam.cosAzimuth - sine * beam.sinAzimuth) +
                     m_origin * cosine);
  points.y.push_back(level * (sine * beam.cosAzimuth + cosine * beam.sinAzimuth) + m_origin * sine);
  points.z.push_back(beyond * beam.sinElevation);
}

}  // namespace polemcl
