#include <arpa/inet.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <cstring>

#include "fuzz/Fuzz.h"
#include "io/file/Bytes.h"
#include "mrpt/live/CUdpOdometry.h"
#include "mrpt/live/HesaiPackets.h"
#include "mrpt/live/LiveQueue.h"
#include "mrpt/live/OusterPackets.h"
#include "mrpt/live/PcapFile.h"
#include "mrpt/rawlog/PoleSequence.h"
#include "support/OusterTurns.h"

namespace polemcl::fuzz {
namespace {

using mrpt::obs::CObservationVelodyneScan;
using Packet = CObservationVelodyneScan::TVelodyneRawPacket;

ObservationPoleExtractor& extractor() {
  static ObservationPoleExtractor one = [] {
    ObservationPoleExtractorOptions options;
    options.sensor.model = "vlp16";
    options.sensor.checkBeams = false;
    return ObservationPoleExtractor(options);
  }();
  return one;
}

/// The poles of a scan of arbitrary packets. The first byte says which LiDAR sent them.
void readPackets(std::string_view bytes) {
  if (bytes.empty()) return;
  static const char* const models[] = {"VLP16", "HDL32", "HDL64"};
  CObservationVelodyneScan scan;
  scan.calibration = mrpt::obs::VelodyneCalibration::LoadDefaultCalibration(
      models[static_cast<unsigned char>(bytes.front()) % 3]);
  scan.timestamp = mrpt::Clock::fromDouble(1e9);
  for (bytes.remove_prefix(1); bytes.size() >= sizeof(Packet); bytes.remove_prefix(sizeof(Packet)))
    std::memcpy(&scan.scan_packets.emplace_back(), bytes.data(), sizeof(Packet));
  extractor().process(scan);
}

std::vector<std::string> streetPackets(std::size_t most) {
  auto packets = testing_apps::turnOfVlp16(testing_apps::streetPoles(), 0, 0, 0);
  packets.resize(std::min(most, packets.size()));
  return packets;
}

std::vector<std::string> packetSeeds() {
  std::string few, turn;
  for (const std::string& packet : streetPackets(2)) few += packet;
  for (const std::string& packet : streetPackets(75)) turn += packet;
  return {inputFor(0, few), inputFor(0, turn), inputFor(1, few), inputFor(2, few)};
}

/// A whole file of packets.
void readPcap(std::string_view bytes) {
  PcapFile file(fileOf("a.pcap", bytes).string());
  RecordedPacket packet;
  for (int i = 0; i < 3000 && file.next(packet); ++i) {
  }
}

std::vector<std::string> pcapSeeds() {
  const auto pcap = [](std::size_t most) {
    return testing_apps::pcapFile(streetPackets(most), 2368);
  };
  std::string fragments = pcap(1);  // which wait for others
  fragments[24 + 16 + 14 + 6] = 0x20;
  return {pcap(3), pcap(75), fragments};
}

/// The file that describes a LiDAR, a zero byte, a packet.
template <class Packets>
void readLidar(std::string_view bytes) {
  const auto zero = bytes.find('\0');
  if (zero == bytes.npos) return;
  const Packets packets(fileOf("lidar", bytes.substr(0, zero)).string());
  LidarPoints points;
  const std::string_view packet = bytes.substr(zero + 1);
  if (!packets.isPacket(packet)) return;
  packets.number(packet);
  packets.turn(packet);
  for (int i = 0; i < packets.columns(packet); ++i) {
    packets.time(packet, i);
    if (packets.phase(packet, i)) packets.append(packet, i, points);
  }
}

void readOuster(std::string_view bytes) {
  readLidar<OusterPackets>(bytes);
}
void readHesai(std::string_view bytes) {
  readLidar<HesaiPackets>(bytes);
}

std::vector<std::string> ousterSeeds() {
  std::vector<std::string> seeds;
  for (const char* profile : {"RNG19_RFL8_SIG16_NIR16", "RNG19_RFL8_SIG16_NIR16_DUAL", "LEGACY"}) {
    testing_apps::OusterModel model;
    model.profile = profile;
    seeds.push_back(model.metadata(",\"column_window\":[0,100]") + std::string(1, '\0') +
                    testing_apps::turnOfOuster(model, 0, 0, 0, 1, 0)[0]);
  }
  return seeds;
}

std::vector<std::string> hesaiSeeds() {
  const std::string folder = POLEMCL_SOURCE_DIR "/tests/mrpt/live/captures/hesai-";
  std::vector<std::string> seeds;
  for (const char* model : {"xt16", "xt32m", "qt64", "64", "40p"}) {
    RecordedPacket packet;
    PcapFile(folder + model + ".pcap").next(packet);
    seeds.push_back(io::readBytes(folder + model + ".csv") + std::string(1, '\0') + packet.bytes);
  }
  return seeds;
}

/// A port of this process on the loopback; neighbours try the next one.
int openOdometry(CUdpOdometry& sensor) {
  for (int port = 20000 + ::getpid() % 20000;; ++port) {
    mrpt::config::CConfigFileMemory config;
    config.write("odometry", "udp_port", port);
    sensor.loadConfig(config, "odometry");
    try {
      sensor.initialize();
      return port;
    } catch (const Error&) {
      if (port > 60000) throw;
    }
  }
}

/// One packet of odometry through the loopback, then the queue of scans.
void readOdometry(std::string_view bytes) {
  static CUdpOdometry sensor;
  static const int port = openOdometry(sensor);
  static const int sender = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ::sendto(sender, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof to);
  sensor.doProcess();
  LiveQueue queue;
  for (const auto& [time, object] : sensor.getObservations())
    queue.push(std::dynamic_pointer_cast<mrpt::obs::CObservation>(object));
  queue.end();
  for (RawlogEntry entry; queue.next(entry);) {
  }
}

/// Scans and odometry with arbitrary times.
void readTimes(std::string_view bytes) {
  Numbers numbers(bytes);
  LiveQueue queue;
  for (int i = 0; i < 1000 && !numbers.atEnd(); ++i) {
    const bool isScan = numbers.byte() % 2 == 0;
    const double real = numbers.real();  // ticks of 100 ns since 1601
    const auto ticks = std::abs(real) < 9e18 ? static_cast<std::int64_t>(real) : 0;
    mrpt::obs::CObservation::Ptr one;
    if (isScan)
      one = CObservationPoles::Create();
    else
      one = mrpt::obs::CObservationOdometry::Create();
    one->timestamp = mrpt::Clock::time_point(mrpt::Clock::duration(ticks));
    queue.push(one);
  }
  queue.end();
  for (RawlogEntry entry; queue.next(entry);) {
  }
}

void readLive(std::string_view bytes) {
  static const Readers readers{readOdometry, readTimes};
  readWithOne(readers, bytes);
}

std::vector<std::string> liveSeeds() {
  return {inputFor(0, "1.5 2 0.25"), inputFor(0, "-1 1e300 nan 5"),
          inputFor(1, std::string(25, '\x40')), inputFor(1, std::string(25, '\x41'))};
}

}  // namespace

std::vector<Target> liveTargets() {
  return {{"packets", readPackets, packetSeeds},
          {"pcap", readPcap, pcapSeeds},
          {"ouster", readOuster, ousterSeeds},
          {"hesai", readHesai, hesaiSeeds},
          {"live", readLive, liveSeeds}};
}

}  // namespace polemcl::fuzz
