#include <algorithm>
#include <cmath>

#include <polemcl/core/mapping/PoleExistence.h>

namespace polemcl {
namespace {

constexpr double kPriorScans = 20;  ///< that the prior of the detection chance counts for
constexpr double kDay = 86400;      ///< s

double logOdds(double probability) {
  return std::log(probability / (1 - probability));
}

}  // namespace

bool isDate(double seconds) {
  constexpr double day = 86400;  // s
  return seconds >= day;
}

void noteSeen(PoleHistory& history, double seconds) {
  if (!isDate(seconds)) return;
  history.firstSeen = history.firstSeen > 0 ? std::min(history.firstSeen, seconds) : seconds;
  history.lastSeen = std::max(history.lastSeen, seconds);
}

double detectionChance(const PoleHistory& history, const ExistenceOptions& options) {
  const double chances = static_cast<double>(history.seen) + history.missed;
  const double own = (kPriorScans * options.detection + history.seen) / (kPriorScans + chances);
  return std::clamp(own, 2 * options.falseDetection, options.detection);
}

double survived(double existence, double seconds, const ExistenceOptions& options) {
  return existence * std::exp(-std::max(0.0, seconds) / (kDay * options.lifetimeDays));
}

void ExistenceEvidence::add(bool found, double along, const ExistenceOptions& options,
                            double chance) {
  const auto look = static_cast<std::int64_t>(along / options.decorrelation);
  if (look != m_look) {
    m_done = logRatio();
    m_sum = 0;
    m_inLook = 0;
    m_look = look;
  }
  m_sum += found ? std::log(chance / options.falseDetection)
                 : std::log((1 - chance) / (1 - options.falseDetection));
  ++m_inLook;
  ++(found ? m_found : m_missed);
}

double ExistenceEvidence::logRatio() const {
  return m_inLook > 0 ? m_done + m_sum / m_inLook : m_done;
}

double updated(double existence, double logRatio, const ExistenceOptions& options) {
  const double low = 1 - options.certain;
  if (logRatio == 0) return std::clamp(existence, low, options.certain);  // to the last bit
  const double odds = logOdds(std::clamp(existence, low, options.certain)) + logRatio;
  return std::clamp(1 / (1 + std::exp(-odds)), low, options.certain);
}

}  // namespace polemcl
