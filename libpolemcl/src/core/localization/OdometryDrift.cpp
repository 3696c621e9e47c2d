#include "core/localization/OdometryDrift.h"

#include "core/common/Transform.h"

namespace polemcl {

void OdometryDrift::add(const Eigen::Vector2d& end, double yaw, const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix2d rotation = rotationOf(yaw);
  m_position += rotation * covariance.topLeftCorner<2, 2>() * rotation.transpose();
  const double heading = covariance(2, 2);
  m_heading += heading;
  m_first += heading * end;
  m_second += heading * end * end.transpose();
}

Eigen::Matrix2d OdometryDrift::between(const OdometryDrift& then, const OdometryDrift& now,
                                       const Eigen::Vector2d& place) {
  const double heading = now.m_heading - then.m_heading;
  const Eigen::Vector2d first = now.m_first - then.m_first;
  // Σ ω² (m - p)(m - p)ᵀ, multiplied out.
  const Eigen::Matrix2d moment = heading * place * place.transpose() - place * first.transpose() -
                                 first * place.transpose() + now.m_second - then.m_second;
  Eigen::Matrix2d covariance = now.m_position - then.m_position;
  covariance(0, 0) += moment(1, 1);  // J·moment·Jᵀ
  covariance(1, 1) += moment(0, 0);
  covariance(0, 1) -= moment(0, 1);
  covariance(1, 0) -= moment(1, 0);
  return covariance;
}

}  // namespace polemcl
