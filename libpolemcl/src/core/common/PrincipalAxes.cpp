#include "core/common/PrincipalAxes.h"

#include <algorithm>
#include <cmath>

#include "core/common/Covariance.h"

namespace polemcl {

std::optional<PrincipalAxes> principalAxes(const Eigen::Matrix2d& covariance) {
  if (!isCovariance(covariance)) return std::nullopt;
  const double xx = covariance(0, 0), yy = covariance(1, 1), xy = covariance(0, 1);
  const double mean = 0.5 * (xx + yy), spread = std::hypot(0.5 * (xx - yy), xy);
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  return PrincipalAxes{mean + spread, std::max(0.0, mean - spread), std::cos(angle),
                       std::sin(angle)};
}

}  // namespace polemcl
