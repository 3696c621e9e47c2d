#include "io/data/Trajectory.h"

#include <Eigen/SVD>
#include <cmath>
#include <functional>

#include "io/file/AtomicFile.h"
#include "io/file/FileKind.h"
#include "io/file/TextFile.h"

namespace polemcl::io {

namespace {

constexpr const char* kTumLayout = "time x y z qx qy qz qw (s, m)";
constexpr int kDecimals = 9;

/// The first row, or the reason why this file has none.
bool firstRow(NumberRowReader& rows, const std::filesystem::path& file,
              std::vector<double>& values) {
  try {
    return rows.next(values);
  } catch (const Error&) {
    const std::string kind = otherKind(file, ".tum");
    if (kind.empty()) throw;
    throw Error(file.string() + ": " + kind + "not a trajectory; expected: " + kTumLayout);
  }
}

/// Reads a TUM file and passes each pose to `consume`.
void readTumRows(const std::filesystem::path& file,
                 const std::function<void(const StampedPose3D&)>& consume) {
  NumberRowReader rows(file, 8, kTumLayout);
  StampedPose3D entry;
  std::size_t count = 0;
  std::vector<double> v;
  for (bool more = firstRow(rows, file, v); more; more = rows.next(v), ++count) {
    if (count > 0 && !(v[0] > entry.time)) {
      throw Error(rows.at() + "time " + significant(v[0], 17) + " is not after " +
                  significant(entry.time, 17) + ", the one before");
    }
    const Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
    if (std::abs(q.norm() - 1) > 0.01) {
      throw Error(rows.at() + "qx qy qz qw have length " + significant(q.norm(), 6) +
                  ", not 1; expected: " + kTumLayout);
    }
    entry.time = v[0];
    entry.pose.linear() = q.normalized().toRotationMatrix();
    entry.pose.translation() = Eigen::Vector3d(v[1], v[2], v[3]);
    consume(entry);
  }
  if (count == 0) throw Error(file.string() + ": no pose in it; expected: " + kTumLayout);
}

bool isFinite(double time, const Eigen::Isometry3d& pose) {
  return std::isfinite(time) && pose.matrix().allFinite();
}

std::string tumRow(double time, const Eigen::Isometry3d& pose) {
  Eigen::Quaterniond q(pose.linear());
  q.normalize();
  std::string row = fixed(time, kDecimals);
  for (const double value : {pose.translation().x(), pose.translation().y(), pose.translation().z(),
                             q.x(), q.y(), q.z(), q.w()}) {
    row += ' ' + fixed(value, kDecimals);
  }
  return row + '\n';
}

}  // namespace

Pose2D planar(const Eigen::Isometry3d& pose) {
  return {pose.translation().x(), pose.translation().y(),
          wrapAngle(std::atan2(pose.linear()(1, 0), pose.linear()(0, 0)))};
}

std::vector<StampedPose2D> planar(const std::vector<StampedPose3D>& trajectory) {
  std::vector<StampedPose2D> result;
  result.reserve(trajectory.size());
  for (const StampedPose3D& entry : trajectory) result.push_back({entry.time, planar(entry.pose)});
  return result;
}

Eigen::Isometry3d spatial(const Pose2D& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.translation() = Eigen::Vector3d(pose.x, pose.y, 0);
  const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
  result.linear() << c, -s, 0, s, c, 0, 0, 0, 1;
  return result;
}

Eigen::Isometry3d poseFromAngles(const Eigen::Vector3d& position, double roll, double pitch,
                                 double yaw) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = position;
  pose.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  return pose;
}

std::vector<StampedPose3D> readTum(const std::filesystem::path& file) {
  std::vector<StampedPose3D> trajectory;
  readTumRows(file, [&](const StampedPose3D& entry) { trajectory.push_back(entry); });
  return trajectory;
}

std::vector<StampedPose2D> readPlanarTum(const std::filesystem::path& file) {
  std::vector<StampedPose2D> trajectory;
  readTumRows(file, [&](const StampedPose3D& entry) {
    trajectory.push_back({entry.time, planar(entry.pose)});
  });
  return trajectory;
}

std::string tumRow(const StampedPose2D& pose) {
  const Eigen::Isometry3d spatialPose = spatial(pose.pose);
  if (!isFinite(pose.time, spatialPose))
    throw Error("the pose at " + std::to_string(pose.time) + " s is not finite");
  return tumRow(pose.time, spatialPose);
}

void writeTum(const std::filesystem::path& file, const std::vector<StampedPose2D>& trajectory) {
  std::vector<StampedPose3D> poses;
  poses.reserve(trajectory.size());
  for (const StampedPose2D& entry : trajectory) poses.push_back({entry.time, spatial(entry.pose)});
  writeTum(file, poses);
}

void writeTum(const std::filesystem::path& file, const std::vector<StampedPose3D>& trajectory) {
  AtomicFile output(file);
  writeTum(output, trajectory);
}

void writeTum(AtomicFile& output, const std::vector<StampedPose3D>& trajectory) {
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const auto& [time, pose] = trajectory[i];
    if (!isFinite(time, pose))
      throw Error("cannot write " + output.target().string() + ": pose " + std::to_string(i) +
                  " (counted from 0) is not finite");
    output.stream() << tumRow(time, pose);
  }
  output.commit();
}

Eigen::Isometry3d poseFromRows(const std::vector<double>& values, const std::string& where) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) pose(row, column) = values.at(4 * row + column);
  }
  const Eigen::Matrix3d rotation = pose.linear();
  const double off =
      (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (off > 1e-3 || rotation.determinant() < 0) {
    throw Error(where + "the 3x3 part is not a rotation (RᵀR differs from identity by " +
                significant(off, 3) + ", determinant " + significant(rotation.determinant(), 3) +
                "); expected: twelve numbers, row-major 3x4 [R|t]");
  }
  // Project onto the nearest rotation.
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rotation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  pose.linear() = svd.matrixU() * svd.matrixV().transpose();
  return pose;
}

std::vector<Eigen::Isometry3d> readKittiPoses(const std::filesystem::path& file) {
  std::vector<Eigen::Isometry3d> poses;
  for (const NumberRow& row : readNumberRows(file, 12, "a pose as row-major 3x4 matrix [R|t], m")) {
    poses.push_back(poseFromRows(row.values, at(file, row.line)));
  }
  if (poses.empty()) {
    throw Error(file.string() + ": no pose in it; expected: twelve numbers a line, row-major 3x4");
  }
  return poses;
}

}  // namespace polemcl::io
