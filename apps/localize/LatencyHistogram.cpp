#include "localize/LatencyHistogram.h"

#include <algorithm>
#include <cmath>

namespace polemcl::apps {

void LatencyHistogram::add(double seconds) {
  const double above = std::log(std::clamp(seconds, shortest, longest) / shortest);
  const auto bin = static_cast<std::size_t>(above / std::log(binRatio));
  ++m_counts[std::min(bin, bins - 1)];
  ++m_count;
  m_sum += seconds;
  m_worst = std::max(m_worst, seconds);
}

double LatencyHistogram::percentile(double share) const {
  if (m_count == 0) return 0;
  const auto rank =
      static_cast<std::uint64_t>(std::max(1.0, std::ceil(share * static_cast<double>(m_count))));
  std::size_t bin = 0;
  for (std::uint64_t below = m_counts[0]; below < rank && bin + 1 < bins; below += m_counts[bin])
    ++bin;
  const double middle = shortest * std::pow(binRatio, static_cast<double>(bin) + 0.5);
  return std::min(middle, m_worst);
}

}  // namespace polemcl::apps
