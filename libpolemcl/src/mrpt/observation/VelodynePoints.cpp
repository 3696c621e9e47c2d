#include "mrpt/observation/VelodynePoints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>

#include <polemcl/core/common/Types.h>

namespace polemcl {
namespace {

using Scan = mrpt::obs::CObservationVelodyneScan;
using Packet = Scan::TVelodyneRawPacket;

constexpr int kFullTurn = Scan::ROTATION_MAX_UNITS;  // hundredths of a degree

struct Direction {
  float cosine, sine;
};

/// One for each hundredth of a degree: packets state azimuths in this unit.
const std::vector<Direction>& directions() {
  static const std::vector<Direction> all = [] {
    std::vector<Direction> table(kFullTurn);
    for (int i = 0; i < kFullTurn; ++i) {
      const double angle = i * 2 * M_PI / kFullTurn;
      table[static_cast<std::size_t>(i)] = {static_cast<float>(std::cos(angle)),
                                            static_cast<float>(std::sin(angle))};
    }
    return table;
  }();
  return all;
}

/// Share of the time to the next block that has passed when a return is measured; times as in the
/// manuals, us. MRPT gives no times to the lasers of an HDL-64E.
double delayOf(int index, std::size_t lasers) {
  const int firing = index / 16, laser = index % 16;
  if (lasers == 16) return (firing * 55.296 + laser * 2.304) / 110.592;
  return lasers == 32 ? index * 1.152 / 46.08 : 0;
}

int rotationOf(const Scan::raw_block_t& block) {
  return block.rotation() % kFullTurn;
}

/// By how much the LiDAR usually turns from block to block of a packet.
int turnedByBlock(const Packet& packet) {
  const int apart = packet.laser_return_mode == Scan::RETMODE_DUAL ? 2 : 1;
  std::array<int, Scan::BLOCKS_PER_PACKET> turned;
  const int count = Scan::BLOCKS_PER_PACKET - apart;
  for (int i = 0; i < count; ++i)
    turned[static_cast<std::size_t>(i)] =
        (kFullTurn + rotationOf(packet.blocks[i + apart]) - rotationOf(packet.blocks[i])) %
        kFullTurn;
  const auto middle = turned.begin() + Scan::BLOCKS_PER_PACKET / 2;
  std::nth_element(turned.begin(), middle, turned.begin() + count);
  return *middle;
}

class Reader {
 public:
  Reader(const Scan& scan, VelodynePoints& points)
      : m_scan(scan), m_lasers(scan.calibration.laser_corrections.size()), m_points(points) {}

  void read(const Packet& packet) {
    const bool isDual = packet.laser_return_mode == Scan::RETMODE_DUAL;
    const int turned = turnedByBlock(packet);
    for (int i = 0; i < Scan::BLOCKS_PER_PACKET; ++i) {
      const auto& block = packet.blocks[i];
      const bool isLower = block.header() == Scan::LOWER_BANK && m_lasers == 64;
      if (!isLower && block.header() != Scan::UPPER_BANK) continue;
      for (int k = 0; k < Scan::SCANS_PER_BLOCK; ++k) {
        const int range = block.laser_returns[k].distance();
        // Both returns of a dual one may be the same.
        if (range == 0 ||
            (isDual && i % 2 == 1 && range == packet.blocks[i - 1].laser_returns[k].distance()))
          continue;
        const int later = static_cast<int>(std::lrint(turned * delayOf(k, m_lasers)));
        add(isLower ? k + 32 : k % static_cast<int>(m_lasers),
            (rotationOf(block) + later) % kFullTurn, range);
      }
    }
  }

 private:
  /// As the manual of the HDL-64E. MRPT's x is y of the manual, and its y is -x; MRPT 2.5.8 passes
  /// over the correction of the azimuth, deg, and takes the offsets for level ones.
  void add(int laser, int azimuth, int range) {
    const auto& calibration = m_scan.calibration.laser_corrections[static_cast<std::size_t>(laser)];
    const int corrected =
        azimuth - static_cast<int>(std::lrint(100 * calibration.azimuthCorrection));
    const double distance =
        range * double{Scan::DISTANCE_RESOLUTION} + calibration.distanceCorrection;
    if (distance < m_scan.minRange || distance > m_scan.maxRange) return;
    const double offset = calibration.verticalOffsetCorrection,
                 aside = calibration.horizontalOffsetCorrection;
    const double level =
        distance * calibration.cosVertCorrection - offset * calibration.sinVertCorrection;
    const auto [cosine, sine] =
        directions()[static_cast<std::size_t>((corrected % kFullTurn + kFullTurn) % kFullTurn)];
    m_points.x.push_back(static_cast<float>(level * cosine + aside * sine));
    m_points.y.push_back(static_cast<float>(aside * cosine - level * sine));
    m_points.z.push_back(static_cast<float>(distance * calibration.sinVertCorrection +
                                            offset * calibration.cosVertCorrection));
    m_points.laser.push_back(laser);
  }

  const Scan& m_scan;
  const std::size_t m_lasers;
  VelodynePoints& m_points;
};

/// A rawlog may hold any numbers.
void requireCalibration(const mrpt::obs::VelodyneCalibration& calibration) {
  for (std::size_t i = 0; i < calibration.laser_corrections.size(); ++i) {
    const auto& laser = calibration.laser_corrections[i];
    const std::string where = "a Velodyne scan has a calibration whose laser " + std::to_string(i);
    if (!std::isfinite(laser.distanceCorrection + laser.verticalOffsetCorrection +
                       laser.horizontalOffsetCorrection + laser.sinVertCorrection +
                       laser.cosVertCorrection))
      throw Error(where + " has a correction that is not finite; record with the right one");
    if (std::abs(laser.azimuthCorrection) <= 360) continue;
    std::ostringstream text;
    text << where << " has an azimuthCorrection of " << laser.azimuthCorrection
         << "; allowed are -360 to 360 degrees: record with the right one";
    throw Error(text.str());
  }
}

}  // namespace

void readVelodynePackets(const Scan& scan, VelodynePoints& points) {
  const std::size_t lasers = scan.calibration.laser_corrections.size();
  if (lasers != 16 && lasers != 32 && lasers != 64)
    throw Error("a Velodyne scan has a calibration of " + std::to_string(lasers) +
                " lasers; allowed are 16, 32 and 64");
  requireCalibration(scan.calibration);
  for (auto* values : {&points.x, &points.y, &points.z}) values->clear();
  points.laser.clear();
  Reader reader(scan, points);
  for (const Packet& packet : scan.scan_packets) reader.read(packet);
}

}  // namespace polemcl
