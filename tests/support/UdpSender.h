#pragma once
// UDP on the loopback without losses: packets wait until those before have been read.

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <fstream>
#include <functional>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace testing_apps {

/// Waits for a condition that will come, on a slow machine too. \return False after two minutes.
inline bool waitFor(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

inline sockaddr_in loopback(int port, const std::string& host = "127.0.0.1") {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, host.c_str(), &address.sin_addr) != 1)
    throw std::runtime_error("no address: " + host);
  return address;
}

/// A port that nobody uses now, each time another one; differs between test programs that run side
/// by side. Below those that the system gives away itself.
inline int freeUdpPort() {
  static int next = 10000 + 64 * (getpid() % 355);  // 64 for each program, with others at once
  for (; next < 32768; ++next) {
    const int probe = socket(AF_INET, SOCK_DGRAM, 0);
    const auto address = loopback(next);
    const bool isFree =
        bind(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    close(probe);
    if (isFree) return next++;
  }
  throw std::runtime_error("no free port");
}

/// Bytes that wait to be read at a UDP port of this computer; none when nobody listens.
inline std::optional<std::size_t> bytesWaiting(int port) {
  std::ifstream table("/proc/net/udp");
  std::string line;
  std::getline(table, line);
  while (std::getline(table, line)) {
    std::istringstream words(line);
    std::string slot, local, remote, state, queues;
    words >> slot >> local >> remote >> state >> queues;
    if (std::stoi(local.substr(local.find(':') + 1), nullptr, 16) != port) continue;
    return std::stoul(queues.substr(queues.find(':') + 1), nullptr, 16);
  }
  return std::nullopt;
}

class UdpSender {
 public:
  /// \param host All of 127.x.y.z are of this computer.
  explicit UdpSender(int port, const std::string& host = "127.0.0.1")
      : m_port(port), m_address(loopback(port, host)), m_socket(socket(AF_INET, SOCK_DGRAM, 0)) {}
  ~UdpSender() { close(m_socket); }
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  bool waitForListener() const {
    return waitFor([this] { return bytesWaiting(m_port).has_value(); });
  }
  /// Returns once the packet has been read, or nobody listens any more.
  void send(const std::string& packet) const {
    put(packet);
    waitUntilRead();
  }
  /// The same for many; as many at once as any buffer holds.
  void sendAll(const std::vector<std::string>& packets) const {
    for (std::size_t i = 0; i < packets.size(); ++i) {
      put(packets[i]);
      if (i % 50 == 49) waitUntilRead();
    }
    waitUntilRead();
  }

 private:
  void put(const std::string& packet) const {
    sendto(m_socket, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&m_address),
           sizeof m_address);
  }
  void waitUntilRead() const {
    waitFor([this] { return bytesWaiting(m_port).value_or(0) == 0; });
  }

  int m_port;
  sockaddr_in m_address;
  int m_socket;
};

}  // namespace testing_apps
