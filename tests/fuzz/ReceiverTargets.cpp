#include <arpa/inet.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>
#include <functional>
#include <memory>
#include <numeric>

#include <polemcl/core/common/Types.h>
#include "fuzz/Fuzz.h"
#include "mrpt/live/LiveQueue.h"
#include "mrpt/live/PacketScanner.h"
#include "mrpt/live/PcapFile.h"
#include "mrpt/live/VelodyneReceiver.h"
#include "support/OusterTurns.h"

namespace polemcl::fuzz {
namespace {

constexpr int kMostSent = 200;  // packets of an input
constexpr int kSentAtOnce = 8;  // fit into any buffer
constexpr int kLastPort = 60000;

/// What a LiDAR sends, and its keys in the file of sensors.
struct Lidar {
  std::string keys;
  std::vector<std::string> packets, positions = {};
};

void send(int port, const std::string& packet) {
  static const int sender = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ::sendto(sender, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof to);
}

/// Listens at two ports from this one on; neighbours try the next ones.
template <class Receiver>
std::unique_ptr<Receiver> opened(const Lidar& lidar, int& port) {
  for (;; port += 2) {
    mrpt::config::CConfigFileMemory config("[lidar]\n" + lidar.keys);
    config.write("lidar", "data_port", port);
    config.write("lidar", "position_port", port + 1);
    auto receiver = std::make_unique<Receiver>();
    receiver->loadConfig(config, "lidar");
    try {
      receiver->initialize();
      return receiver;
    } catch (const Error&) {
      if (port > kLastPort) throw;
    }
  }
}

std::size_t wordOf(Numbers& numbers) {
  const unsigned low = numbers.byte();
  return low + 256 * numbers.byte();
}

/// Changes up to seven bytes; one behind the end changes the length.
void change(std::string& packet, Numbers& numbers) {
  for (unsigned changes = numbers.byte() % 8; changes > 0; --changes) {
    const std::size_t at = wordOf(numbers);
    const unsigned value = numbers.byte();
    if (at < packet.size())
      packet[at] = static_cast<char>(value);
    else
      packet.resize(8 * value);
  }
}

/// Packets of a LiDAR in any order, changed or not, through the loopback and the queue of scans.
template <class Receiver>
void receive(const Lidar& lidar, std::string_view bytes) {
  static int port = 20000 + ::getpid() % 20000;
  const auto receiver = opened<Receiver>(lidar, port);
  Numbers numbers(bytes);
  LiveQueue queue;
  int waiting = 0;
  for (int i = 0; i < kMostSent && !numbers.atEnd(); ++i) {
    const std::size_t which = wordOf(numbers) % (lidar.packets.size() + lidar.positions.size());
    const bool isPosition = which >= lidar.packets.size();
    std::string packet =
        isPosition ? lidar.positions[which - lidar.packets.size()] : lidar.packets[which];
    change(packet, numbers);
    send(isPosition ? port + 1 : port, packet);
    waiting += isPosition ? 0 : 1;
    if (waiting < kSentAtOnce && !numbers.atEnd()) continue;
    if (waiting > 0) receiver->doProcess();  // it would wait for some
    waiting = 0;
    for (const auto& [time, object] : receiver->getObservations())
      queue.push(std::dynamic_pointer_cast<mrpt::obs::CObservation>(object));
  }
  queue.end();
  for (RawlogEntry entry; queue.next(entry);) {
  }
}

/// Says that it is this time of 2025-03-23.
std::string positionPacket(char validity, const std::string& time) {
  const std::string fix =
      "GPRMC," + time + "," + validity + ",4807.038,N,01131.000,E,022.4,084.4,230325,003.1,W";
  const int sum = std::accumulate(fix.begin(), fix.end(), 0, std::bit_xor<>());
  char end[8];
  std::snprintf(end, sizeof end, "*%02X\r\n", static_cast<unsigned>(sum));
  const std::string line = "$" + fix + end;
  std::string packet(512, '\0');
  return packet.replace(206, line.size(), line);
}

Lidar velodyne(const std::string& model) {
  Lidar lidar{"model = " + model + "\npos_packets_min_period = 0\n", {}};
  std::uint32_t clock = 3599900000;  // us; the hour ends in the second turn
  for (int turn = 0; turn < 3; ++turn)
    for (std::string& packet :
         testing_apps::turnOfVlp16(testing_apps::streetPoles(), 0.5 * turn, 0, 0)) {
      std::string time;
      testing_apps::appendBytes(time, clock);
      clock = (clock + 1327) % 3600000000;
      lidar.packets.push_back(packet.replace(1200, 4, time));
    }
  for (const char* time : {"105959", "110000"})
    for (const char validity : {'A', 'V'})
      lidar.positions.push_back(positionPacket(validity, time));
  return lidar;
}

Lidar ouster(const std::string& profile, const std::string& more) {
  testing_apps::OusterModel model;
  model.profile = profile;
  const std::string name = "ouster-" + profile;
  Lidar lidar{"metadata_file = " + fileOf(name, model.metadata()).string() + "\n" + more, {}};
  for (int turn = 0; turn < 3; ++turn)
    for (std::string& packet :
         testing_apps::turnOfOuster(model, 0.5 * turn, 0, 0, 65534 + turn,
                                    5'000'000'000 + static_cast<std::uint64_t>(turn) * 100'000'000))
      lidar.packets.push_back(std::move(packet));
  return lidar;
}

Lidar hesai(const std::string& model, const std::string& more) {
  const std::string path = POLEMCL_SOURCE_DIR "/tests/mrpt/live/captures/hesai-" + model;
  Lidar lidar{"calibration_file = " + path + ".csv\n" + more, {}};
  PcapFile file(path + ".pcap");
  for (RecordedPacket packet; file.next(packet);) lidar.packets.push_back(packet.bytes);
  return lidar;
}

template <class Receiver>
std::function<void(std::string_view)> readerOf(Lidar lidar) {
  return [lidar = std::move(lidar)](std::string_view bytes) { receive<Receiver>(lidar, bytes); };
}

void readReceivers(std::string_view bytes) {
  static const std::string clock = "sensor_time = true\n";
  static const Readers readers{
      readerOf<VelodyneReceiver>(velodyne("VLP16")),
      readerOf<VelodyneReceiver>(velodyne("HDL32")),
      readerOf<VelodyneReceiver>(velodyne("HDL64")),
      readerOf<COusterScanner>(ouster("RNG19_RFL8_SIG16_NIR16", "")),
      readerOf<COusterScanner>(ouster("RNG19_RFL8_SIG16_NIR16_DUAL", clock)),
      readerOf<COusterScanner>(ouster("LEGACY", "")),
      readerOf<CHesaiScanner>(hesai("xt16", clock)),
      readerOf<CHesaiScanner>(hesai("xt32", "")),
      readerOf<CHesaiScanner>(hesai("xt32m", "")),
      readerOf<CHesaiScanner>(hesai("qt64", "")),
      readerOf<CHesaiScanner>(hesai("64", clock)),
      readerOf<CHesaiScanner>(hesai("40p", ""))};
  readWithOne(readers, bytes);
}

/// A packet in an input, with bytes changed.
std::string sent(std::size_t which,
                 const std::vector<std::pair<std::size_t, unsigned>>& changes = {}) {
  std::string bytes;
  testing_apps::appendBytes(bytes, static_cast<std::uint16_t>(which));
  bytes.push_back(static_cast<char>(changes.size()));
  for (const auto& [at, value] : changes) {
    testing_apps::appendBytes(bytes, static_cast<std::uint16_t>(at));
    bytes.push_back(static_cast<char>(value));
  }
  return bytes;
}

std::vector<std::string> receiverSeeds() {
  std::vector<std::string> seeds;
  std::string drive;  // three turns with losses, and their GPS
  for (std::size_t i = 0; i < 225; i += 5)
    drive += (i % 75 == 0 ? sent(225 + i / 75) : "") + sent(i);
  for (std::size_t reader = 0; reader < 3; ++reader) seeds.push_back(inputFor(reader, drive));
  drive.clear();
  for (std::size_t i = 0; i < 192; i += 4) drive += sent(i);
  for (std::size_t reader = 3; reader < 6; ++reader)
    seeds.push_back(inputFor(reader, drive + sent(3, {{0xFFFF, 100}})));
  drive.clear();  // the first azimuth, in hundredths of a degree, goes round
  for (const unsigned high : {10u, 60u, 120u, 5u, 70u, 130u, 8u})
    for (const std::size_t header : {8u, 12u}) drive += sent(0, {{header + 1, high}});
  for (std::size_t reader = 6; reader < 12; ++reader) seeds.push_back(inputFor(reader, drive));
  return seeds;
}

}  // namespace

std::vector<Target> receiverTargets() {
  return {{"receivers", readReceivers, receiverSeeds}};
}

}  // namespace polemcl::fuzz
