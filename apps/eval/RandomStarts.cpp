#include "eval/RandomStarts.h"

#include <algorithm>
#include <random>

#include "io/file/TextFile.h"

namespace polemcl::apps {

std::vector<std::size_t> drawStarts(const std::vector<double>& driven, int trials, double metres,
                                    std::uint32_t seed) {
  if (trials < 1) throw Error("at least 1 trial is needed");
  if (!(metres > 0)) throw Error("a trial must be longer than 0 m");
  const double length = driven.empty() ? 0 : driven.back();
  if (length <= metres)
    throw Error("the drive is " + io::fixed(length, 1) + " m long, but each trial takes " +
                io::fixed(metres, 1) + " m: give a longer one or fewer metres");
  const auto last = std::upper_bound(driven.begin(), driven.end(), length - metres);
  const auto count = static_cast<std::uint64_t>(last - driven.begin());
  std::mt19937_64 random(seed);
  std::vector<std::size_t> starts;
  starts.reserve(trials);
  for (int i = 0; i < trials; ++i) starts.push_back(random() % count);
  return starts;
}

}  // namespace polemcl::apps
