#include "sim/common/Random.h"

#include <algorithm>
#include <array>

#include "core/common/Statistics.h"

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

double normalFromHash(std::uint64_t bits) {
  static const auto table = makeTable();
  const std::size_t cell = bits >> (64 - kTableBits);
  const double share = static_cast<double>((bits << kTableBits) >> 40) * 0x1p-24;
  return table[cell] + share * (table[cell + 1] - table[cell]);
}

}  // namespace polemcl::sim
