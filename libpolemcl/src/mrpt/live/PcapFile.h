#pragma once
/// \file PcapFile.h
/// \brief UDP packets of a recording (tcpdump, Wireshark). Part of the module
/// libpolemcl-sensors.so.

#include <netinet/in.h>

#include <deque>
#include <memory>
#include <string>
#include <string_view>

struct pcap;  // of libpcap

namespace polemcl {

struct RecordedPacket {
  std::string bytes;  ///< what was sent
  in_addr sender;
  int port;     ///< that it was sent to
  double time;  ///< Unix time of the recording, s; of its last fragment
};

/// \brief A file of libpcap: PCAP or PCAPNG, from an Ethernet interface, all interfaces, or without
/// a link layer.
///
/// Packets of more than about 1,500 bytes travel in fragments (IPv4); they are put together. What
/// is cut, damaged, or no UDP over IPv4 is passed over.
class PcapFile {
 public:
  /// \throws Error when it is no such file, or of another link layer.
  explicit PcapFile(const std::string& file);
  /// \brief The next packet. \return false at the end. \throws Error when the file is damaged.
  bool next(RecordedPacket& packet);

 private:
  struct Datagram {
    std::string key;              ///< sender, receiver and number
    std::string bytes;            ///< after the header of IP
    std::size_t arrived = 0;      ///< bytes so far
    std::size_t size = SIZE_MAX;  ///< of all, once the last fragment is there
  };
  bool takeIp(std::string_view bytes, RecordedPacket& packet);
  bool takeFragment(const std::string& key, std::size_t offset, bool isLast,
                    std::string_view content);

  std::string m_file;
  std::unique_ptr<pcap, void (*)(pcap*)> m_recording;
  int m_link;
  std::deque<Datagram> m_waiting;  ///< for fragments, the newest last
};

}  // namespace polemcl
