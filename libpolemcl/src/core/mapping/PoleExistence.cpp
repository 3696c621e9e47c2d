#include "core/mapping/PoleExistence.h"

#include <algorithm>
#include <cmath>

namespace polemcl {
namespace {

constexpr double kPriorScans = 20;  ///< that the prior of the detection chance counts for
constexpr double kDay = 86400;      ///< s
/// Chance that a scan finds a pole though something stands before it, at most.
constexpr double kHiddenChance = 0.3;

double logOdds(double probability) {
  return std::log(probability / (1 - probability));
}

}  // namespace

bool isDate(double seconds) {
  return seconds >= kDay;
}

void noteSeen(PoleHistory& history, double seconds) {
  if (!isDate(seconds)) return;
  history.firstSeen = history.firstSeen > 0 ? std::min(history.firstSeen, seconds) : seconds;
  history.lastSeen = std::max(history.lastSeen, seconds);
}

double detectionChance(const PoleHistory& history) {
  const double chances = static_cast<double>(history.seen) + history.missed;
  const double own = (kPriorScans * kDetection + history.seen) / (kPriorScans + chances);
  return std::clamp(own, 2 * kFalseDetection, kDetection);
}

double survived(double existence, double seconds, double lifetimeDays) {
  return existence * std::exp(-std::max(0.0, seconds) / (kDay * lifetimeDays));
}

void ExistenceLikelihood::SectionSum::add(std::int64_t number, double value) {
  if (number != section) *this = {total(), 0, 0, number};
  sum += value;
  ++inSection;
}

double ExistenceLikelihood::SectionSum::total() const {
  return inSection > 0 ? done + sum / inSection : done;
}

void ExistenceLikelihood::add(bool found, double along, double chance, bool hidden) {
  if (hidden) chance = std::min(chance, std::max(kHiddenChance, 2 * kFalseDetection));
  const auto section = static_cast<std::int64_t>(along / kDecorrelation);
  const double value =
      found ? std::log(chance / kFalseDetection) : std::log((1 - chance) / (1 - kFalseDetection));
  m_inView.add(section, hidden ? 0 : value);  // a section counts by the share of its scans in view
  m_all.add(section, value);
  m_found += found;
  m_missed += !found && !hidden;
  m_foundHidden |= found && hidden;
}

double ExistenceLikelihood::logRatio() const {
  return m_foundHidden ? m_all.total() : m_inView.total();
}

double updated(double existence, double logRatio) {
  const double low = 1 - kCertain;
  if (logRatio == 0) return std::clamp(existence, low, kCertain);  // to the last bit
  const double odds = logOdds(std::clamp(existence, low, kCertain)) + logRatio;
  return std::clamp(1 / (1 + std::exp(-odds)), low, kCertain);
}

}  // namespace polemcl
