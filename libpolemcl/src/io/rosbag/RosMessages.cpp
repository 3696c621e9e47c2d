#include "io/rosbag/RosMessages.h"

#include <cmath>
#include <utility>

namespace polemcl::io {
namespace {

/// A frame without the slash that programs of ROS 1 put before it.
std::string readFrame(CdrReader& reader) {
  std::string frame = reader.getText();
  if (!frame.empty() && frame.front() == '/') frame.erase(0, 1);
  return frame;
}

Eigen::Vector3d readVector(CdrReader& reader) {
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) vector[i] = reader.getFinite<double>();
  return vector;
}

/// x, y, z, then the quaternion x, y, z, w.
std::optional<Eigen::Isometry3d> readPose(CdrReader& reader) {
  Eigen::Vector3d position;
  Eigen::Quaterniond rotation;
  for (int i = 0; i < 3; ++i) position[i] = reader.get<double>();
  for (int i = 0; i < 4; ++i) rotation.coeffs()[i] = reader.get<double>();
  if (!position.allFinite() || !(std::abs(rotation.norm() - 1) < 0.01)) return std::nullopt;
  return Eigen::Translation3d(position) * Eigen::Isometry3d(rotation.normalized());
}

/// Rows of a square matrix. The numbers are not checked: several drivers write what is not a
/// covariance.
template <int size>
Eigen::Matrix<double, size, size> readCovariance(CdrReader& reader) {
  Eigen::Matrix<double, size, size> matrix;
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) matrix(row, column) = reader.get<double>();
  return matrix;
}

std::vector<PackedField> readFields(CdrReader& reader) {
  constexpr std::size_t kLeast = 4 + 4 + 1 + 4;  // an empty name, offset, type, count
  std::vector<PackedField> fields(reader.getCount(kLeast));
  for (PackedField& field : fields) {
    field.name = reader.getText();
    field.offset = reader.get<std::uint32_t>();
    field.type = reader.get<std::uint8_t>();
    reader.get<std::uint32_t>();  // values in a field of several; the first one is read
  }
  return fields;
}

PackedCloud readPacked(CdrReader& reader, double stamp) {
  PackedCloud packed;
  packed.stamp = stamp;
  packed.rows = reader.get<std::uint32_t>();
  packed.columns = reader.get<std::uint32_t>();
  packed.fields = readFields(reader);
  packed.bigEndian = reader.get<std::uint8_t>() != 0;
  packed.pointBytes = reader.get<std::uint32_t>();
  packed.rowBytes = reader.get<std::uint32_t>();
  packed.data = reader.getBytes();
  reader.get<std::uint8_t>();  // whether all points are valid
  return packed;
}

}  // namespace

RosHeader readHeader(CdrReader& reader) {
  const auto seconds = reader.get<std::int32_t>();
  const auto nanoseconds = reader.get<std::uint32_t>();
  if (nanoseconds >= 1000000000u)
    reader.fail("the stamp has " + std::to_string(nanoseconds) +
                " nanoseconds; less than 1000000000 are allowed");
  return {seconds + nanoseconds * 1e-9, readFrame(reader)};
}

RosOdometry decodeOdometry(std::string_view message, const std::string& where) {
  CdrReader reader(message, where);
  RosOdometry odometry;
  odometry.header = readHeader(reader);
  odometry.child = readFrame(reader);
  odometry.T_odom_child = readPose(reader);
  readCovariance<6>(reader);                         // of the pose, which grows without limit
  for (int i = 0; i < 6; ++i) reader.get<double>();  // velocities
  odometry.twistCovariance = readCovariance<6>(reader);
  return odometry;
}

RosImu decodeImu(std::string_view message, const std::string& where) {
  CdrReader reader(message, where);
  RosImu imu;
  imu.header = readHeader(reader);
  for (int i = 0; i < 4; ++i) reader.get<double>();  // orientation, which many IMUs do not have
  readCovariance<3>(reader);
  imu.rate = readVector(reader);
  imu.rateCovariance = readCovariance<3>(reader);
  for (int i = 0; i < 3; ++i) reader.get<double>();  // acceleration
  readCovariance<3>(reader);
  return imu;
}

RosNavSatFix decodeNavSatFix(std::string_view message, const std::string& where) {
  CdrReader reader(message, where);
  RosNavSatFix fix;
  fix.header = readHeader(reader);
  fix.status = reader.get<std::int8_t>();
  reader.get<std::uint16_t>();  // systems of satellites in use
  fix.latitude = reader.get<double>();
  fix.longitude = reader.get<double>();
  reader.get<double>();  // height
  fix.covariance = readCovariance<3>(reader);
  fix.covarianceType = reader.get<std::uint8_t>();
  return fix;
}

std::vector<RosTransform> decodeTransforms(std::string_view message, const std::string& where) {
  constexpr std::size_t kLeast = 8 + 4 + 4 + 7 * 8;  // stamp, two empty names, seven numbers
  CdrReader reader(message, where);
  std::vector<RosTransform> transforms(reader.getCount(kLeast));
  for (RosTransform& transform : transforms) {
    transform.header = readHeader(reader);
    transform.child = readFrame(reader);
    transform.T_parent_child = readPose(reader);
  }
  return transforms;
}

RosCloud decodeCloud(std::string_view message, const std::string& where, bool withTimes) {
  CdrReader reader(message, where);
  RosCloud result;
  result.header = readHeader(reader);
  static_cast<TimedCloud&>(result) =
      unpack(readPacked(reader, result.header.time), where, withTimes);
  return result;
}

}  // namespace polemcl::io
