#include "mrpt/live/PcapFile.h"

#include <pcap/pcap.h>

#include <algorithm>
#include <cstring>

#include <polemcl/core/common/Types.h>

namespace polemcl {
namespace {

constexpr std::size_t kMostWaiting = 16;  // datagrams; fragments of one follow each other
constexpr std::size_t kUdpHeader = 8, kLongestDatagram = 65535;  // bytes
constexpr int kUdp = 17, kIpv4 = 0x0800, kVlan = 0x8100, kOuterVlan = 0x88A8;

int byteAt(std::string_view bytes, std::size_t i) {
  return static_cast<unsigned char>(bytes[i]);
}

/// Two bytes, the high one first.
int shortAt(std::string_view bytes, std::size_t i) {
  return byteAt(bytes, i) << 8 | byteAt(bytes, i + 1);
}

/// What follows a header that holds its kind two bytes from `kind`; empty if that is not IPv4.
std::string_view afterHeader(std::string_view bytes, std::size_t kind, std::size_t size) {
  while (bytes.size() >= size && size >= kind + 2) {
    const int content = shortAt(bytes, kind);
    if (content == kIpv4) return bytes.substr(size);
    if (content != kVlan && content != kOuterVlan) break;
    kind = size + 2;
    size += 4;
  }
  return {};
}

std::string_view withoutLinkLayer(std::string_view bytes, int link) {
  switch (link) {
    case DLT_EN10MB:
      return afterHeader(bytes, 12, 14);
    case DLT_LINUX_SLL:
      return afterHeader(bytes, 14, 16);
    case DLT_LINUX_SLL2:
      return bytes.size() < 20 || shortAt(bytes, 0) != kIpv4 ? std::string_view()
                                                             : bytes.substr(20);
    default:
      return bytes;
  }
}

}  // namespace

PcapFile::PcapFile(const std::string& file) : m_file(file), m_recording(nullptr, &pcap_close) {
  char reason[PCAP_ERRBUF_SIZE] = "";
  m_recording.reset(pcap_open_offline(file.c_str(), reason));
  // libpcap names the file in some reasons, not in all.
  if (!m_recording) throw Error("cannot read " + file + " as PCAP: " + reason);
  m_link = pcap_datalink(m_recording.get());
  for (const int known : {DLT_EN10MB, DLT_LINUX_SLL, DLT_LINUX_SLL2, DLT_RAW, DLT_IPV4})
    if (m_link == known) return;
  throw Error(file + ": packets of link type " + std::to_string(m_link) +
              "; allowed are those of Ethernet and of Linux (1, 101, 113, 228, 276): record with "
              "tcpdump at the interface of the LiDAR");
}

bool PcapFile::next(RecordedPacket& packet) {
  for (;;) {
    pcap_pkthdr* head = nullptr;
    const u_char* content = nullptr;
    const int status = pcap_next_ex(m_recording.get(), &head, &content);
    if (status == PCAP_ERROR_BREAK) return false;
    if (status != 1) throw Error(m_file + ": is damaged: " + pcap_geterr(m_recording.get()));
    const std::string_view bytes(reinterpret_cast<const char*>(content), head->caplen);
    packet.time =
        static_cast<double>(head->ts.tv_sec) + 1e-6 * static_cast<double>(head->ts.tv_usec);
    if (takeIp(withoutLinkLayer(bytes, m_link), packet)) return true;
  }
}

/// \return Whether a packet is complete.
bool PcapFile::takeIp(std::string_view bytes, RecordedPacket& packet) {
  if (bytes.size() < 20 || byteAt(bytes, 0) >> 4 != 4 || byteAt(bytes, 9) != kUdp) return false;
  const std::size_t header = static_cast<std::size_t>(byteAt(bytes, 0) & 15) * 4;
  const auto size = static_cast<std::size_t>(shortAt(bytes, 2));
  const int place = shortAt(bytes, 6);  // flags, then where the fragment begins, in 8 bytes
  const bool isLast = (place & 0x2000) == 0;
  const auto offset = static_cast<std::size_t>(place & 0x1FFF) * 8;
  // Some recorders leave out the size.
  const std::size_t end = size == 0 ? bytes.size() : size;
  if (header < 20 || end < header || end > bytes.size()) return false;
  std::string_view datagram = bytes.substr(header, end - header);
  if (!isLast || offset > 0) {
    const std::string key = std::string(bytes.substr(12, 8)) + std::string(bytes.substr(4, 2));
    if (!takeFragment(key, offset, isLast, datagram)) return false;
    datagram = m_waiting.back().bytes;
  }
  const bool isWhole = datagram.size() >= kUdpHeader;
  if (isWhole) {
    std::memcpy(&packet.sender, bytes.data() + 12, sizeof packet.sender);
    packet.port = shortAt(datagram, 2);
    packet.bytes = datagram.substr(kUdpHeader);
  }
  if (!isLast || offset > 0) m_waiting.pop_back();
  return isWhole;
}

/// \return Whether the datagram, then the last of those that wait, is complete.
bool PcapFile::takeFragment(const std::string& key, std::size_t offset, bool isLast,
                            std::string_view content) {
  const std::size_t end = offset + content.size();
  if (end > kLongestDatagram) return false;
  auto found = std::find_if(m_waiting.begin(), m_waiting.end(),
                            [&](const Datagram& one) { return one.key == key; });
  // Numbers come again after a while: what waits for its begin is then another datagram.
  Datagram one{key, {}, 0, SIZE_MAX};
  if (found != m_waiting.end()) {
    if (offset > 0) one = std::move(*found);
    m_waiting.erase(found);
  }
  if (one.bytes.size() < end) one.bytes.resize(end);
  content.copy(one.bytes.data() + offset, content.size());
  one.arrived += content.size();
  if (isLast) one.size = end;
  const bool isComplete = one.arrived == one.size;
  m_waiting.push_back(std::move(one));
  if (m_waiting.size() > kMostWaiting) m_waiting.pop_front();
  return isComplete;
}

}  // namespace polemcl
