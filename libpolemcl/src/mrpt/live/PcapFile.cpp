#include "mrpt/live/PcapFile.h"

#include <cstdint>
#include <fstream>
#include <optional>

#include <polemcl/core/common/Types.h>
#include "io/file/Bytes.h"

namespace polemcl {
namespace {

constexpr std::uint32_t kEthernet = 1;

/// Numbers of a file in the byte order that it states.
class Numbers {
 public:
  explicit Numbers(const std::string& file) : m_file(file), m_stream(file, std::ios::binary) {
    if (!m_stream) throw Error("cannot read " + file);
  }
  void setBigEndian(bool isBig) { m_isBig = isBig; }
  bool isBigEndian() const { return m_isBig; }
  std::uint32_t at(std::uint64_t offset) {
    char bytes[4];
    if (!m_stream.seekg(static_cast<std::streamoff>(offset)).read(bytes, sizeof bytes))
      throw Error(m_file + ": is no PCAP file, or it ends early");
    return m_isBig ? io::loadBigEndian<std::uint32_t>(bytes)
                   : io::loadLittleEndian<std::uint32_t>(bytes);
  }

 private:
  std::string m_file;
  std::ifstream m_stream;
  bool m_isBig = false;
};

/// The link type in the header of a PCAP file; none in another file.
std::optional<std::uint32_t> linkOfPcap(Numbers& numbers) {
  for (const bool isBig : {false, true}) {
    numbers.setBigEndian(isBig);
    const std::uint32_t magic = numbers.at(0);  // of microseconds and of nanoseconds
    if (magic == 0xA1B2C3D4 || magic == 0xA1B23C4D) return numbers.at(20) & 0x03FFFFFF;
  }
  return std::nullopt;
}

/// The link type of the first interface of a PCAP-NG file; none in another file.
std::optional<std::uint32_t> linkOfPcapNg(Numbers& numbers) {
  constexpr std::uint32_t kSection = 0x0A0D0D0A, kInterface = 1, kLeast = 12, kMost = 1 << 24;
  numbers.setBigEndian(false);
  if (numbers.at(0) != kSection) return std::nullopt;
  numbers.setBigEndian(numbers.at(8) == 0x4D3C2B1A);
  if (numbers.at(8) != 0x1A2B3C4D) return std::nullopt;
  std::uint64_t block = 0;
  while (numbers.at(block) != kInterface) {
    const std::uint32_t size = numbers.at(block + 4);
    if (size < kLeast || size > kMost) return std::nullopt;
    block += size;
  }
  const std::uint32_t link = numbers.at(block + 8);  // 16 bits, then 16 of no use
  return numbers.isBigEndian() ? link >> 16 : link & 0xFFFF;
}

}  // namespace

void requireEthernetPcap(const std::string& file) {
  Numbers numbers(file);
  std::optional<std::uint32_t> link = linkOfPcap(numbers);
  if (!link) link = linkOfPcapNg(numbers);
  if (!link) throw Error(file + ": is no PCAP file");
  if (*link != kEthernet)
    throw Error(file + ": packets of link type " + std::to_string(*link) +
                "; only Ethernet, type 1, can be read: record at the interface of the LiDAR");
}

}  // namespace polemcl
