#include "map/DriveDoubts.h"

#include "io/file/TextFile.h"

namespace polemcl::apps {
std::string odometryDoubt(const FilledMotions& filled) {
  if (filled.contradicted == 0) return {};
  return "the poles contradict " + std::to_string(filled.contradicted) +
         (filled.contradicted == 1 ? " motion" : " motions") + " of its odometry, the first at " +
         io::fixed(filled.firstContradicted, 3) +
         " s, and told the way there; check whether the odometry slips or starts anew";
}

std::string fixesDoubt(const FixFit& fit) {
  if (!fit.isDoubtful()) return {};
  return std::to_string(fit.given - fit.fitting) + " of " + std::to_string(fit.given) +
         " positions from satellites do not fit its path, they lie " + io::fixed(fit.distance, 2) +
         " m from it (median); the map may lie wrong on Earth by far more: a wrong clock shifts it "
         "by speed times time; check their clock (GPS time is 18 s ahead of UTC), the place of the "
         "antenna and sigma";
}

}  // namespace polemcl::apps
