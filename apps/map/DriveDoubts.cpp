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

}  // namespace polemcl::apps
