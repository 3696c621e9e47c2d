#include "mrpt/live/CUdpOdometry.h"

#include <mrpt/obs/CObservationOdometry.h>

#include <cmath>
#include <sstream>
#include <vector>

IMPLEMENTS_GENERIC_SENSOR(CUdpOdometry, polemcl)

namespace polemcl {
namespace {

constexpr std::size_t kLongestPacket = 200, kLongestShown = 60;

constexpr double kFarthestTime = 10;  // s

/// None for packets that are ignored. \param now Time of arrival, Unix time, s: for those without
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

void CUdpOdometry::loadConfig_sensorSpecific(const mrpt::config::CConfigFileBase& config,
                                             const std::string& section) {
  m_port = config.read_int(section, "udp_port", 0);
  m_address = config.read_string(section, "address", m_address);
}

void CUdpOdometry::initialize() {
  m_socket.open("udp_port", m_port, m_address);
}

void CUdpOdometry::doProcess() {
  m_state = ssWorking;
  if (m_socket.wait()) m_socket.receive([this](const UdpPacket& packet) { take(packet); });
}

void CUdpOdometry::take(const UdpPacket& packet) {
  const std::string text(packet.bytes.substr(0, kLongestPacket));
  const auto odometry = parse(text, mrpt::Clock::toDouble(packet.arrival));
  if (!odometry) {
    if (!m_ignored) m_ignored = text.substr(0, kLongestShown);
    return;
  }
  odometry->sensorLabel = m_sensorLabel;
  appendObservation(odometry);
}

}  // namespace polemcl
