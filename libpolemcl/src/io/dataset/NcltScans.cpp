#include "io/dataset/NcltScans.h"

#include <array>
#include <cerrno>
#include <cmath>
#include <fstream>

#include "core/common/Angles.h"
#include "io/data/TrackSampler.h"
#include "io/data/Trajectory.h"
#include "io/file/Bytes.h"
#include "io/file/ReadLimits.h"

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kHitBytes = 8, kHitHeaderBytes = 24;
constexpr std::uint16_t kHitMagic = 44444;
constexpr double kNearest = 0.5;          ///< m; nearer points are not returns
constexpr double kLongestPause = 0.05;    ///< longest time between packets, s; usual: 0.55 ms
constexpr double kWidestStep = M_PI / 4;  ///< largest step of azimuth between packets; usual: 2°

double metres(const char* value) {
  return loadLittleEndian<std::uint16_t>(value) * 0.005 - 100.0;
}

Eigen::Vector3d pointAt(const char* bytes) {
  return {metres(bytes), metres(bytes + 2), metres(bytes + 4)};
}

/// Adds `count` points, transformed by `move`.
void addPoints(const char* bytes, std::size_t count, const Eigen::Isometry3d& move, Cloud& cloud) {
  for (std::size_t i = 0; i < count; ++i, bytes += kHitBytes) {
    const Eigen::Vector3d raw = pointAt(bytes);
    if (raw.squaredNorm() < 1e-6) {  // no return
      ++cloud.invalid;
      continue;
    }
    const Eigen::Vector3d point = move * raw;
    cloud.x.push_back(static_cast<float>(point.x()));
    cloud.y.push_back(static_cast<float>(point.y()));
    cloud.z.push_back(static_cast<float>(point.z()));
    cloud.intensity.push_back(static_cast<float>(static_cast<unsigned char>(bytes[6])));
  }
}

struct Packet {
  std::uint64_t offset = 0;  ///< offset of its header, bytes
  double time = 0;           ///< s
  std::string points;        ///< raw bytes from the file
  std::uint64_t bytes() const { return kHitHeaderBytes + points.size(); }
};

/// Reads packet after packet.
class PacketReader {
 public:
  PacketReader(const fs::path& file, std::uint64_t begin, std::uint64_t end)
      : m_file(file), m_position(begin), m_end(end) {
    errno = 0;
    m_stream.open(file, std::ios::binary);
    if (!m_stream) throw Error("cannot read " + file.string() + ": " + std::strerror(errno));
    m_stream.seekg(static_cast<std::streamoff>(begin));
  }

  bool next(Packet& packet) {
    if (m_position == m_end) return false;
    packet.offset = m_position;
    std::array<char, kHitHeaderBytes> header;
    take(header.data(), header.size());
    for (std::size_t i = 0; i < 4; ++i) {
      if (loadLittleEndian<std::uint16_t>(header.data() + 2 * i) != kHitMagic)
        throw Error(where(packet.offset) +
                    "no packet of velodyne_hits.bin begins here (four times 44444 expected)");
    }
    const auto count = loadLittleEndian<std::uint32_t>(header.data() + 8);
    if (count > kMostPacketPoints)
      throw Error(where(packet.offset) + "a packet of " + std::to_string(count) +
                  " points; at most " + std::to_string(kMostPacketPoints) + " are allowed");
    packet.time = static_cast<double>(loadLittleEndian<std::uint64_t>(header.data() + 12)) * 1e-6;
    packet.points.resize(count * kHitBytes);
    take(packet.points.data(), packet.points.size());
    return true;
  }

 private:
  std::string where(std::uint64_t offset) const {
    return m_file.string() + ": byte " + std::to_string(offset) + ": ";
  }
  void take(char* to, std::size_t size) {
    m_stream.read(to, static_cast<std::streamsize>(size));
    if (m_position + size > m_end || static_cast<std::size_t>(m_stream.gcount()) != size)
      throw Error(where(m_position) + "cut short: " + std::to_string(size) +
                  " bytes of a packet expected");
    m_position += size;
  }

  fs::path m_file;
  std::ifstream m_stream;
  std::uint64_t m_position, m_end;
};

/// Azimuth of the first return; nullopt if the packet has no return.
std::optional<double> azimuthOf(const Packet& packet) {
  for (std::size_t i = 0; i < packet.points.size(); i += kHitBytes) {
    const Eigen::Vector3d point = pointAt(packet.points.data() + i);
    if (point.head<2>().norm() >= kNearest) return std::atan2(point.y(), point.x());
  }
  return std::nullopt;
}

/// Joins packets to revolutions.
class TurnFinder {
 public:
  void add(const Packet& packet) {
    const auto azimuth = azimuthOf(packet);
    if (m_open && !follows(packet, azimuth)) {
      ++m_leftOut;
      m_open = false;
    }
    if (!m_open) {
      open(packet);
      m_turned = 0;
    } else if (azimuth && m_azimuth) {
      m_turned += wrapAngle(*azimuth - *m_azimuth);
      if (std::abs(m_turned) >= 2 * M_PI) {
        close();
        open(packet);
        m_turned -= std::copysign(2 * M_PI, m_turned);
      }
    }
    m_turn.bytes += packet.bytes();
    m_turn.end = packet.time;
    if (azimuth) m_azimuth = azimuth;
  }

  std::size_t leftOut() const { return m_leftOut + (m_open ? 1 : 0); }
  std::vector<NcltTurn> turns;

 private:
  bool follows(const Packet& packet, const std::optional<double>& azimuth) const {
    const double pause = packet.time - m_turn.end;
    const bool near =
        !azimuth || !m_azimuth || std::abs(wrapAngle(*azimuth - *m_azimuth)) <= kWidestStep;
    return pause >= 0 && pause <= kLongestPause && near;
  }
  void open(const Packet& packet) {
    m_turn = {packet.offset, 0, packet.time, 0, packet.time};
    m_azimuth.reset();
    m_open = true;
  }
  void close() {
    m_turn.middle = (m_turn.begin + m_turn.end) / 2;
    const bool later = turns.empty() || m_turn.middle > turns.back().middle;
    if (later)
      turns.push_back(m_turn);
    else
      ++m_leftOut;
  }

  NcltTurn m_turn;
  bool m_open = false;
  double m_turned = 0;              ///< azimuth since the start of the revolution, rad, signed
  std::optional<double> m_azimuth;  ///< azimuth of the previous packet in this revolution
  std::size_t m_leftOut = 0;
};

/// Transform from the time of a packet to the middle of its revolution.
Eigen::Isometry3d toMiddle(double time, const NcltTurn& turn,
                           const std::optional<TurnMotion>& motion) {
  const double half = (turn.end - turn.begin) / 2;
  if (!motion || half <= 0) return Eigen::Isometry3d::Identity();
  return interpolate(Eigen::Isometry3d::Identity(),
                     time < turn.middle ? motion->T_middle_begin : motion->T_middle_end,
                     std::abs(time - turn.middle) / half);
}

}  // namespace

Cloud readNcltSync(const fs::path& file) {
  const std::string bytes = readBytes(file);
  if (bytes.size() % kHitBytes != 0)
    throw Error(file.string() + ": cut short: " + std::to_string(bytes.size()) +
                " bytes are not a multiple of 8 (uint16 x y z, uint8 intensity, laser a point)");
  Cloud cloud;
  addPoints(bytes.data(), bytes.size() / kHitBytes, Eigen::Isometry3d::Identity(), cloud);
  return cloud;
}

Eigen::Isometry3d ncltBodyLidar() {
  return poseFromAngles({0.002, -0.004, -0.957}, 0.807 * degree, 0.166 * degree, -90.703 * degree);
}

std::vector<NcltTurn> findNcltTurns(const fs::path& file, std::vector<std::string>& notes,
                                    const ReadProgress& progress) {
  std::error_code error;
  const std::uint64_t size = fs::file_size(file, error);
  if (error) throw Error("cannot read " + file.string() + ": " + error.message());
  PacketReader reader(file, 0, size);
  TurnFinder finder;
  Packet packet;
  constexpr std::uint64_t kMegabyte = 1000000;
  for (std::size_t packets = 0; reader.next(packet); ++packets) {
    finder.add(packet);
    if (progress && packets % 1000 == 0) progress(packet.offset / kMegabyte, size / kMegabyte);
  }
  if (finder.turns.empty())
    throw Error(file.string() + ": no whole turn of the LiDAR in its " + std::to_string(size) +
                " bytes");
  notes.push_back(file.filename().string() + ": " + std::to_string(finder.turns.size()) +
                  " whole turns, " + std::to_string(finder.leftOut()) +
                  " incomplete ones left out");
  return std::move(finder.turns);
}

Cloud readNcltTurn(const fs::path& file, const NcltTurn& turn,
                   const std::optional<TurnMotion>& motion) {
  PacketReader reader(file, turn.offset, turn.offset + turn.bytes);
  const Eigen::Isometry3d T_body_lidar = ncltBodyLidar();
  Cloud cloud;
  Packet packet;
  while (reader.next(packet)) {
    addPoints(packet.points.data(), packet.points.size() / kHitBytes,
              toMiddle(packet.time, turn, motion) * T_body_lidar, cloud);
  }
  return cloud;
}

}  // namespace polemcl::io
