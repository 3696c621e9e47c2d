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
#include <vector>

#include <polemcl/core/common/Types.h>

IMPLEMENTS_GENERIC_SENSOR(CUdpOdometry, polemcl)

namespace polemcl {
namespace {

constexpr int kLongestWait = 10;  // ms
constexpr std::size_t kLongestPacket = 200, kLongestShown = 60;

constexpr double kFarthestTime = 10;  // s

/// None for packets that are ignored. \param now The clock here, Unix time, s: for those without
/// time.
mrpt::obs::CObservationOdometry::Ptr parse(const std::string& text, double now) {
  std::istringstream in(text);
  std::vector<double> numbers;
  for (double number = 0; in >> number;) numbers.push_back(number);
  if (!in.eof() || numbers.size() < 3 || numbers.size() > 4) return nullptr;
  numbers.push_back(now);
  for (const double number : numbers)
    if (!std::isfinite(number)) return nullptr;
  if (std::abs(numbers[3] - now) > kFarthestTime) return nullptr;
  auto odometry = mrpt::obs::CObservationOdometry::Create();
  odometry->odometry = mrpt::poses::CPose2D(numbers[0], numbers[1], numbers[2]);
  odometry->timestamp = mrpt::Clock::fromDouble(numbers[3]);
  return odometry;
}

// Known as soon as the module is loaded.
[[maybe_unused]] const bool kRegistered = (CUdpOdometry::doRegister(), true);

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
  if (poll(&ready, 1, kLongestWait) <= 0) return;
  char packet[kLongestPacket];
  const auto size = recv(m_socket, packet, sizeof packet, MSG_DONTWAIT);
  if (size < 0) return;
  const std::string text(packet, static_cast<std::size_t>(size));
  const auto odometry = parse(text, mrpt::Clock::nowDouble());
  if (!odometry) {
    if (!m_ignored) m_ignored = text.substr(0, kLongestShown);
    return;
  }
  odometry->sensorLabel = m_sensorLabel;
  appendObservation(odometry);
}

}  // namespace polemcl
