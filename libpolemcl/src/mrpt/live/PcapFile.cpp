#include "mrpt/live/PcapFile.h"

#include <pcap/pcap.h>

#include <memory>

#include <polemcl/core/common/Types.h>

namespace polemcl {

void requireEthernetPcap(const std::string& file) {
  char reason[PCAP_ERRBUF_SIZE] = "";
  const std::unique_ptr<pcap_t, decltype(&pcap_close)> recording(
      pcap_open_offline(file.c_str(), reason), &pcap_close);
  // libpcap names the file in some reasons, not in all.
  if (!recording) throw Error("cannot read " + file + " as PCAP: " + reason);
  const int link = pcap_datalink(recording.get());
  if (link != DLT_EN10MB)
    throw Error(file + ": packets of link type " + std::to_string(link) +
                "; only Ethernet, type 1, can be read: record at the interface of the LiDAR");
}

}  // namespace polemcl
