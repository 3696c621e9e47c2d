#include "cli/RawlogActions.h"

#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/poses/CPosePDFGaussian.h>

namespace polemcl::apps {

mrpt::obs::CActionCollection makeActions(const std::optional<PoseWithCovariance>& motion,
                                         const mrpt::Clock::time_point& stamp) {
  mrpt::obs::CActionCollection collection;
  if (!motion) return collection;
  mrpt::obs::CActionRobotMovement2D movement;
  movement.timestamp = stamp;
  movement.estimationMethod = mrpt::obs::CActionRobotMovement2D::emScan2DMatching;
  const auto& mean = motion->mean;
  movement.poseChange =
      mrpt::poses::CPosePDFGaussian::Create(mrpt::poses::CPose2D(mean.x, mean.y, mean.yaw),
                                            mrpt::math::CMatrixDouble33(motion->covariance));
  collection.insert(movement);
  return collection;
}

PoseWithCovariance standstill() {
  const Eigen::Vector3d sigma(io::motionFloorMetres, io::motionFloorMetres, io::motionFloorRadians);
  return {Pose2D{}, sigma.cwiseAbs2().asDiagonal()};
}

}  // namespace polemcl::apps
