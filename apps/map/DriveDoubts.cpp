#include "map/DriveDoubts.h"

#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

/// Share of positions that may not fit. In streets between high houses some always do not.
constexpr double kManyWrong = 0.3;

}  // namespace

std::string odometryDoubt(const FilledMotions& filled) {
  if (filled.contradicted == 0) return {};
  return "the poles contradict " + std::to_string(filled.contradicted) +
         (filled.contradicted == 1 ? " motion" : " motions") + " of its odometry, the first at " +
         io::fixed(filled.firstContradicted, 3) +
         " s, and told the way there; check whether the odometry slips or starts anew";
}

std::string fixesDoubt(const FixFit& fit) {
  const std::size_t wrong = fit.given - fit.fitting;
  if (!(static_cast<double>(wrong) > kManyWrong * static_cast<double>(fit.given))) return {};
  return std::to_string(wrong) + " of " + std::to_string(fit.given) +
         " positions from satellites do not fit its path, they lie " + io::fixed(fit.distance, 2) +
         " m from it (median); the map may lie wrong by as much: check their clock (GPS time is 18 "
         "s ahead of UTC), the place of the antenna and sigma";
}

}  // namespace polemcl::apps
