#include "mrpt/live/PacketSource.h"

#include <algorithm>
#include <thread>

#include <polemcl/core/common/Types.h>

namespace polemcl {

using std::chrono::steady_clock;

namespace {

constexpr std::chrono::milliseconds kPlayAtOnce(10);
constexpr double kLongestPause = 5;  // s in the file; longer ones are left out

}  // namespace

void PacketSource::loadConfig(const mrpt::config::CConfigFileBase& config,
                              const std::string& section) {
  m_address = config.read_string(section, "address", m_address);
  m_deviceIp = config.read_string(section, "device_ip", m_deviceIp);
  m_pcap = config.read_string(section, "pcap_input", m_pcap);
  m_once = config.read_bool(section, "pcap_read_once", m_once);
  m_fast = config.read_bool(section, "pcap_read_fast", m_fast);
}

void PacketSource::open(std::vector<LidarPort> ports) {
  m_ports = std::move(ports);
  if (!m_deviceIp.empty()) m_device = ipv4Address("device_ip", m_deviceIp);
  const std::string address = m_address.empty() ? "127.0.0.1" : m_address;
  for (const LidarPort& port : m_ports) {
    requirePort(port.key, port.number);
    if (m_pcap.empty()) m_sockets.emplace_back().open(port.key, port.number, address);
  }
  if (!m_pcap.empty()) m_file.emplace(m_pcap);
}

void PacketSource::take(const Take& take, std::size_t port, const UdpPacket& packet) {
  if (m_device && packet.sender.s_addr != m_device->s_addr)
    ++m_ignored;
  else
    take(port, packet);
}

void PacketSource::receive(const Take& take) {
  if (m_file) return play(take);
  m_sockets.front().wait();
  for (std::size_t port = m_sockets.size(); port-- > 0;)
    m_sockets[port].receive([&](const UdpPacket& packet) { this->take(take, port, packet); });
}

std::optional<std::size_t> PacketSource::indexOf(int port) const {
  const auto found = std::find_if(m_ports.begin(), m_ports.end(),
                                  [&](const LidarPort& one) { return one.number == port; });
  if (found == m_ports.end()) return std::nullopt;
  return static_cast<std::size_t>(found - m_ports.begin());
}

/// The first port is that of the scans.
void PacketSource::requirePackets() const {
  const LidarPort& scans = m_ports.front();
  if (m_packets.count(scans.number) > 0) return;
  std::vector<std::pair<std::size_t, int>> most;
  for (const auto& [port, packets] : m_packets) most.emplace_back(packets, port);
  std::sort(most.rbegin(), most.rend());
  most.resize(std::min<std::size_t>(most.size(), 5));
  std::string there;
  for (const auto& [packets, port] : most)
    there += (there.empty() ? "" : ", ") + std::to_string(packets) + " for " + std::to_string(port);
  throw Error(m_pcap + ": has no UDP packet for " + scans.key + " = " +
              std::to_string(scans.number) + (there.empty() ? "" : "; there are " + there));
}

/// \return false at the end of the file.
bool PacketSource::readNext() {
  m_next.emplace();
  while (m_file->next(*m_next)) {
    ++m_packets[m_next->port];
    if (indexOf(m_next->port)) return true;
  }
  m_next.reset();
  requirePackets();
  if (!m_once) m_file.emplace(m_pcap);
  m_begin.reset();
  m_atEnd = m_once;
  return false;
}

void PacketSource::play(const Take& take) {
  const auto until = steady_clock::now() + kPlayAtOnce;
  while (steady_clock::now() <= until && !m_atEnd && (m_next || readNext())) {
    if (!m_begin || m_next->time - m_begin->second > kLongestPause)
      m_begin = {steady_clock::now(), m_next->time};
    const auto due =
        m_begin->first +
        std::chrono::duration_cast<steady_clock::duration>(
            std::chrono::duration<double>(m_fast ? 0 : m_next->time - m_begin->second));
    std::this_thread::sleep_until(std::min(due, until));
    if (due > until) return;
    m_begin = {due, m_next->time};
    const RecordedPacket packet = std::move(*m_next);
    m_next.reset();
    const std::string_view bytes(packet.bytes);
    this->take(take, *indexOf(packet.port),
               {bytes, bytes.size(), packet.sender, mrpt::Clock::now()});
    if (m_fast) return;
  }
}

}  // namespace polemcl
