#include "sim/common/NormalDistribution.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace polemcl::sim {
namespace {

constexpr int kTableBits = 12;

std::array<double, (1 << kTableBits) + 1> makeTable() {
  std::array<double, (1 << kTableBits) + 1> table{};
  constexpr double kCount = 1 << kTableBits;
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] =
        normalQuantile(std::clamp(static_cast<double>(i) / kCount, 0.2 / kCount, 1 - 0.2 / kCount));
  return table;
}

}  // namespace

double normalCdf(double x) {
  return 0.5 * std::erfc(-x * M_SQRT1_2);
}

double bivariateNormalCdf(double h, double k, double correlation) {
  static constexpr double kNodes[] = {0.0950125098376374, 0.2816035507792589, 0.4580167776572274,
                                      0.6178762444026438, 0.7554044083550030, 0.8656312023878318,
                                      0.9445750230732326, 0.9894009349916499};
  static constexpr double kWeights[] = {0.1894506104550685, 0.1826034150449236, 0.1691565193950025,
                                        0.1495959888165767, 0.1246289712555339, 0.0951585116824928,
                                        0.0622535239386479, 0.0271524594117541};
  const double half = 0.5 * std::asin(correlation);
  double sum = 0;
  for (int i = 0; i < 8; ++i)
    for (const double side : {-1.0, 1.0}) {
      const double s = std::sin(half * (1 + side * kNodes[i]));
      sum += kWeights[i] * std::exp(-(h * h + k * k - 2 * h * k * s) / (2 * (1 - s * s)));
    }
  return normalCdf(h) * normalCdf(k) + half * sum / (2 * M_PI);
}

double normalFromHash(std::uint64_t bits) {
  static const auto table = makeTable();
  const std::size_t cell = bits >> (64 - kTableBits);
  const double share = static_cast<double>((bits << kTableBits) >> 40) * 0x1p-24;
  return table[cell] + share * (table[cell + 1] - table[cell]);
}

}  // namespace polemcl::sim
