#pragma once
/// \file UdpSocket.h
/// \brief UDP packets with the times of their arrival. Part of the module libpolemcl-sensors.so.

#include <mrpt/core/Clock.h>
#include <netinet/in.h>

#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace polemcl {

/// \brief The address of a text such as 192.168.1.201. \throws Error naming the key that has it.
in_addr ipv4Address(const std::string& key, const std::string& text);

/// \throws Error naming the key, unless it is 1 to 65535.
void requirePort(const std::string& key, int port);

struct UdpPacket {
  std::string_view bytes;  ///< at most UdpSocket::kLongest of them
  std::size_t size;        ///< as it was sent
  in_addr sender;
  mrpt::Clock::time_point arrival;  ///< time stamp of the kernel
};

class UdpSocket {
 public:
  static constexpr std::size_t kLongest = 65507;  ///< that UDP has

  UdpSocket();
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  /// \brief Listens, with a large buffer for what is not read at once.
  /// \param key Of the port, for errors. \param address IPv4; 0.0.0.0: packets from anywhere.
  /// \throws Error for other ports than 1 to 65535, and when the port cannot be listened at.
  void open(const std::string& key, int port, const std::string& address);
  /// \brief Waits some milliseconds for the next packet. \return false when none came.
  bool wait() const;
  /// \brief The packets that are there, in their order; returns at once.
  void receive(const std::function<void(const UdpPacket&)>& take) const;

 private:
  struct Batch;

  int m_socket = -1;
  std::unique_ptr<Batch> m_batch;
};

}  // namespace polemcl
