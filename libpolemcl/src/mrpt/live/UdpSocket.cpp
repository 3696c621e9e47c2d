#include "mrpt/live/UdpSocket.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include <polemcl/core/common/Types.h>

namespace polemcl {
namespace {

constexpr int kLongestWait = 10;       // ms
constexpr int kBuffer = 32 << 20;      // bytes; a second of the fastest LiDAR
constexpr std::size_t kAtOnce = 32;    // packets of one call of the kernel
constexpr std::size_t kRounds = 1000;  // of such calls, so that a flood cannot hold a thread

mrpt::Clock::time_point arrivalOf(msghdr& head) {
  for (cmsghdr* part = CMSG_FIRSTHDR(&head); part; part = CMSG_NXTHDR(&head, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_TIMESTAMPNS) continue;
    timespec time;
    std::memcpy(&time, CMSG_DATA(part), sizeof time);
    return mrpt::Clock::fromDouble(0) +
           std::chrono::duration_cast<mrpt::Clock::duration>(
               std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec));
  }
  return mrpt::Clock::now();
}

}  // namespace

/// Where the kernel writes packets.
struct UdpSocket::Batch {
  struct Slot {
    char bytes[UdpSocket::kLongest];
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(timespec))];
    sockaddr_in sender;
    iovec part;
  };
  std::array<Slot, kAtOnce> slots;
  std::array<mmsghdr, kAtOnce> heads;

  /// The kernel writes over the sizes.
  void prepare() {
    for (std::size_t i = 0; i < kAtOnce; ++i) {
      Slot& slot = slots[i];
      slot.part = {slot.bytes, sizeof slot.bytes};
      heads[i] = {};
      msghdr& head = heads[i].msg_hdr;
      head.msg_iov = &slot.part;
      head.msg_iovlen = 1;
      head.msg_name = &slot.sender;
      head.msg_namelen = sizeof slot.sender;
      head.msg_control = slot.control;
      head.msg_controllen = sizeof slot.control;
    }
  }
};

in_addr ipv4Address(const std::string& key, const std::string& text) {
  in_addr address;
  if (inet_pton(AF_INET, text.c_str(), &address) != 1)
    throw Error(key + " = " + text + ": is no IPv4 address, such as 127.0.0.1");
  return address;
}

void requirePort(const std::string& key, int port) {
  if (port < 1 || port > 65535)
    throw Error(key + " = " + std::to_string(port) + ": allowed is 1 to 65535");
}

// The slots are not set to zero: most of them are never used.
UdpSocket::UdpSocket() : m_batch(new Batch) {}

UdpSocket::~UdpSocket() {
  if (m_socket >= 0) close(m_socket);
}

void UdpSocket::open(const std::string& key, int port, const std::string& address) {
  requirePort(key, port);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(static_cast<std::uint16_t>(port));
  at.sin_addr = ipv4Address("address", address);
  m_socket = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (m_socket < 0 || bind(m_socket, reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0)
    throw Error(key + " = " + std::to_string(port) + " at " + address + ": " +
                std::strerror(errno));
  const int yes = 1;
  setsockopt(m_socket, SOL_SOCKET, SO_RCVBUF, &kBuffer, sizeof kBuffer);  // as far as it is allowed
  setsockopt(m_socket, SOL_SOCKET, SO_TIMESTAMPNS, &yes, sizeof yes);
}

bool UdpSocket::wait() const {
  pollfd ready{m_socket, POLLIN, 0};
  return poll(&ready, 1, kLongestWait) > 0;
}

void UdpSocket::receive(const std::function<void(const UdpPacket&)>& take) const {
  for (std::size_t round = 0; round < kRounds; ++round) {
    m_batch->prepare();
    const int count =
        recvmmsg(m_socket, m_batch->heads.data(), kAtOnce, MSG_DONTWAIT | MSG_TRUNC, nullptr);
    for (int i = 0; i < count; ++i) {
      auto& [head, size] = m_batch->heads[static_cast<std::size_t>(i)];
      const auto& slot = m_batch->slots[static_cast<std::size_t>(i)];
      take({{slot.bytes, std::min<std::size_t>(size, kLongest)},
            size,
            slot.sender.sin_addr,
            arrivalOf(head)});
    }
    if (count < static_cast<int>(kAtOnce)) return;
  }
}

}  // namespace polemcl
