#include "io/dataset/RosbagFixes.h"

#include <cmath>

#include "io/dataset/ScanFixes.h"
#include "io/rosbag/RosMessages.h"

namespace polemcl::io {

namespace {

double sigmaOf(const RosNavSatFix& message) {
  const double variance = (message.covariance(0, 0) + message.covariance(1, 1)) / 2;
  const bool isStated = message.covarianceType > 0 && std::isfinite(variance) && variance > 0;
  return isStated ? std::sqrt(variance) : kAssumedFixSigma;
}

}  // namespace

void addRosbagFixes(const Bag& bag, std::size_t topic, const FrameTree& frames,
                    const std::string& robot, ScanFolder& folder) {
  for (const BagMessage& message : bag.messages(topic)) {
    const RosNavSatFix read = decodeNavSatFix(bag.read(message), bag.place(message));
    if (read.status < 0) continue;
    GnssFix fix;
    fix.time = read.header.time;
    fix.latitude = read.latitude;
    fix.longitude = read.longitude;
    fix.sigma = sigmaOf(read);
    if (const auto T_robot_antenna = frames.find(robot, read.header.frame))
      fix.antenna_robot = T_robot_antenna->translation().head<2>();
    takeFix(fix, folder);
  }
  finishFixes(bag.topics()[topic].name, folder);
}

}  // namespace polemcl::io
