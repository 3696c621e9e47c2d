#include "sim/common/NormalDistribution.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace polemcl::sim {
namespace {

constexpr int kTableBits = 12;

std::array<double, (1 << kTableBits) + 1> makeTable() {
  std::array<double, (1 << kTableBits) + 1> table{};
  constexpr double count = 1 << kTableBits;
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] =
        normalQuantile(std::clamp(static_cast<double>(i) / count, 0.2 / count, 1 - 0.2 / count));
  return table;
}

template <std::size_t n>
double polynomial(const double (&c)[n], double x) {
  double sum = c[0];
  for (std::size_t i = 1; i < n; ++i) sum = sum * x + c[i];
  return sum;
}

}  // namespace

double normalCdf(double x) {
  return 0.5 * std::erfc(-x * M_SQRT1_2);
}

double normalQuantile(double p) {
  static constexpr double a[] = {-3.969683028665376e+01, 2.209460984245205e+02,
                                 -2.759285104469687e+02, 1.383577518672690e+02,
                                 -3.066479806614716e+01, 2.506628277459239e+00};
  static constexpr double b[] = {-5.447609879822406e+01, 1.615858368580409e+02,
                                 -1.556989798598866e+02, 6.680131188771972e+01,
                                 -1.328068155288572e+01, 1.0};
  static constexpr double c[] = {-7.784894002430293e-03, -3.223964580411365e-01,
                                 -2.400758277161838e+00, -2.549732539343734e+00,
                                 4.374664141464968e+00,  2.938163982698783e+00};
  static constexpr double d[] = {7.784695709041462e-03, 3.224671290700398e-01,
                                 2.445134137142996e+00, 3.754408661907416e+00, 1.0};
  p = std::clamp(p, 1e-9, 1 - 1e-9);
  constexpr double low = 0.02425;
  if (p < low) {
    const double q = std::sqrt(-2 * std::log(p));
    return polynomial(c, q) / polynomial(d, q);
  }
  if (p > 1 - low) return -normalQuantile(1 - p);
  const double q = p - 0.5, r = q * q;
  return polynomial(a, r) * q / polynomial(b, r);
}

double bivariateNormalCdf(double h, double k, double correlation) {
  static constexpr double x[] = {0.0950125098376374, 0.2816035507792589, 0.4580167776572274,
                                 0.6178762444026438, 0.7554044083550030, 0.8656312023878318,
                                 0.9445750230732326, 0.9894009349916499};
  static constexpr double w[] = {0.1894506104550685, 0.1826034150449236, 0.1691565193950025,
                                 0.1495959888165767, 0.1246289712555339, 0.0951585116824928,
                                 0.0622535239386479, 0.0271524594117541};
  const double half = 0.5 * std::asin(correlation);
  double sum = 0;
  for (int i = 0; i < 8; ++i)
    for (const double side : {-1.0, 1.0}) {
      const double s = std::sin(half * (1 + side * x[i]));
      sum += w[i] * std::exp(-(h * h + k * k - 2 * h * k * s) / (2 * (1 - s * s)));
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
