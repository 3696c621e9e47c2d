#include "core/localization/OdometryDrift.h"

#include "core/common/Transform.h"

namespace polemcl {

void OdometryDrift::add(const Eigen::Vector2d& end, double yaw, const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix2d rotation = rotationOf(yaw);
  m_position += rotation * covariance.topLeftCorner<2, 2>() * rotation.transpose();
  const double heading = covariance(2, 2);
  m_heading += heading;
  const Eigen::Vector2d p = end - m_origin;
  m_first += heading * p;
  m_second += heading * p * p.transpose();
}

Eigen::Matrix2d OdometryDrift::between(const OdometryDrift& then, const OdometryDrift& now,
                                       const Eigen::Vector2d& place_local) {
  const Eigen::Vector2d place = place_local - now.m_origin;
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

OdometryDrift OdometryDrift::countedFrom(const OdometryDrift& zero,
                                         const Eigen::Vector2d& origin) const {
  const Eigen::Vector2d shift = origin - m_origin;
  OdometryDrift drift;
  drift.m_origin = origin;
  drift.m_position = m_position - zero.m_position;
  drift.m_heading = m_heading - zero.m_heading;
  const Eigen::Vector2d first = m_first - zero.m_first;
  drift.m_first = first - drift.m_heading * shift;
  drift.m_second = m_second - zero.m_second - first * shift.transpose() -
                   shift * first.transpose() + drift.m_heading * shift * shift.transpose();
  return drift;
}

}  // namespace polemcl
