#pragma once
/// \file PacketSource.h
/// \brief Where the packets of a LiDAR come from. Part of the module libpolemcl-sensors.so.

#include <mrpt/config/CConfigFileBase.h>

#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mrpt/live/PcapFile.h"
#include "mrpt/live/UdpSocket.h"

namespace polemcl {

struct LidarPort {
  std::string key;  ///< of the setting, for errors
  int number;
};

/// \brief UDP ports of this computer, or a PCAP file in place of the LiDAR.
///
/// A file is played at the pace of its recording; packets count as arriving when they are played.
/// Keys: `address`, the IPv4 address to listen at (default: 127.0.0.1, this computer only; 0.0.0.0:
/// from anywhere), `device_ip`, the only sender (default: that of the first measurements),
/// `pcap_input`, `pcap_read_once` (default: true) and
/// `pcap_read_fast` (one packet for each call).
class PacketSource {
 public:
  using Take = std::function<void(std::size_t port, const UdpPacket& packet)>;

  void loadConfig(const mrpt::config::CConfigFileBase& config, const std::string& section);
  /// \throws Error when a port cannot be listened at, or a file or an address is none.
  void open(std::vector<LidarPort> ports);
  /// \brief The packets that are there; waits some milliseconds for one to the first port.
  /// \param take With the index of the port. \throws Error for a file that is damaged, or has no
  /// packet to the first port.
  void receive(const Take& take);
  /// \brief From now on only packets of this sender, unless there is an only one: packets of two
  /// LiDARs on one port are not mixed.
  void keepTo(const in_addr& sender) {
    if (!m_device) m_device = sender;
  }
  /// \brief Whether all packets of the file have been taken.
  bool atEnd() const { return m_atEnd; }
  /// \brief Whether it listens without `address`.
  bool isOfThisComputerOnly() const { return m_pcap.empty() && m_address.empty(); }
  const std::string& pcap() const { return m_pcap; }  ///< the file; empty: ports
  /// \brief Packets of other senders.
  std::size_t ignored() const { return m_ignored; }

 private:
  void play(const Take& take);
  void requirePackets() const;
  bool readNext();
  void take(const Take& take, std::size_t port, const UdpPacket& packet);
  std::optional<std::size_t> indexOf(int port) const;

  std::vector<LidarPort> m_ports;
  std::string m_address, m_deviceIp, m_pcap;
  bool m_once = true, m_fast = false, m_atEnd = false;
  std::optional<in_addr> m_device;  ///< the only sender
  std::deque<UdpSocket> m_sockets;  ///< of the ports
  std::optional<PcapFile> m_file;
  std::optional<RecordedPacket> m_next;  ///< of the file
  std::map<int, std::size_t> m_packets;  ///< of the file, by port
  /// When the first packet of the file was played, and its time in the file.
  std::optional<std::pair<std::chrono::steady_clock::time_point, double>> m_begin;
  std::size_t m_ignored = 0;
};

/// \brief A sensor of MRPT that takes packets.
class PacketReceiver {
 public:
  struct Counts {
    std::size_t packets = 0;  ///< of measurements
    std::size_t lost = 0;     ///< missing between those
    std::size_t ignored = 0;  ///< of a wrong size or another sender
  };
  virtual ~PacketReceiver() = default;
  Counts counts() const {
    Counts all = m_counts;
    all.ignored += m_source.ignored();
    return all;
  }
  const PacketSource& source() const { return m_source; }

 protected:
  PacketSource m_source;
  Counts m_counts;  ///< without the packets of other senders
};

}  // namespace polemcl
