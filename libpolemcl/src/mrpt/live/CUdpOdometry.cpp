#include "mrpt/live/CUdpOdometry.h"

#include <arpa/inet.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <sstream>

#include <polemcl/core/common/Types.h>

IMPLEMENTS_GENERIC_SENSOR(CUdpOdometry, polemcl)

namespace polemcl {
namespace {

constexpr int longestWait = 10;  // ms
constexpr std::size_t longestPacket = 200, longestShown = 60;

/// None unless the text is three finite numbers.
std::optional<mrpt::poses::CPose2D> parse(const std::string& text) {
  std::istringstream in(text);
  double x = 0, y = 0, yaw = 0;
  std::string rest;
  const bool good = (in >> x >> y >> yaw) && !(in >> rest);
  if (!good || !std::isfinite(x) || !std::isfinite(y) || !std::isfinite(yaw)) return std::nullopt;
  return mrpt::poses::CPose2D(x, y, yaw);
}

}  // namespace

CUdpOdometry::~CUdpOdometry() {
  if (m_socket >= 0) close(m_socket);
}

void CUdpOdometry::loadConfig_sensorSpecific(const mrpt::config::CConfigFileBase& config,
                                             const std::string& section) {
  m_port = config.read_int(section, "udp_port", 0);
  m_address = config.read_string(section, "address", m_address);
}

void CUdpOdometry::initialize() {
  if (m_port < 1 || m_port > 65535)
    throw Error("udp_port = " + std::to_string(m_port) + ": allowed is 1 to 65535");
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(static_cast<std::uint16_t>(m_port));
  if (inet_pton(AF_INET, m_address.c_str(), &at.sin_addr) != 1)
    throw Error("address = " + m_address + ": is no IPv4 address, such as 127.0.0.1");
  m_socket = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (m_socket < 0 || bind(m_socket, reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0)
    throw Error("port " + std::to_string(m_port) + " of " + m_address + ": " +
                std::strerror(errno));
}

void CUdpOdometry::doProcess() {
  m_state = ssWorking;
  pollfd ready{m_socket, POLLIN, 0};
  if (poll(&ready, 1, longestWait) <= 0) return;
  char packet[longestPacket];
  const auto size = recv(m_socket, packet, sizeof packet, MSG_DONTWAIT);
  if (size < 0) return;
  const std::string text(packet, static_cast<std::size_t>(size));
  const auto pose = parse(text);
  if (!pose) {
    if (!m_ignored) m_ignored = text.substr(0, longestShown);
    return;
  }
  const auto odometry = mrpt::obs::CObservationOdometry::Create();
  odometry->timestamp = mrpt::Clock::now();
  odometry->sensorLabel = m_sensorLabel;
  odometry->odometry = *pose;
  appendObservation(odometry);
}

}  // namespace polemcl
