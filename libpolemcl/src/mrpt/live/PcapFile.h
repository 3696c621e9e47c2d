#pragma once
/// \file PcapFile.h
/// \brief Checks recordings of packets before MRPT reads them. Part of the module
/// libpolemcl-sensors.so.

#include <string>

namespace polemcl {

/// \brief MRPT takes packets of Ethernet for granted: with others it crashes.
/// \throws Error naming the file: it cannot be read, is no PCAP or PCAP-NG, or not of Ethernet.
void requireEthernetPcap(const std::string& file);

}  // namespace polemcl
