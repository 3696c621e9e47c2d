#include <cmath>
#include <limits>

#include "io/data/Trajectory.h"
#include "support/IoFiles.h"

namespace polemcl::test_trajectory {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;

using TrajectoryTest = FolderTest;

constexpr double kRootHalf = 0.70710678118654752;

TEST_F(TrajectoryTest, PlanarByHand) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  // 30° about z, then 20° nose up: yaw stays 30°.
  pose.linear() = (Eigen::AngleAxisd(M_PI / 6, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(-M_PI / 9, Eigen::Vector3d::UnitY()))
                      .toRotationMatrix();
  pose.translation() << 1, 2, 3;
  const Pose2D result = planar(pose);
  EXPECT_EQ(result.x, 1);
  EXPECT_EQ(result.y, 2);
  EXPECT_NEAR(result.yaw, M_PI / 6, 1e-15);
}

TEST_F(TrajectoryTest, PlanarKeepsYawInItsInterval) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << -1, 0, 0, -0.0, -1, 0, 0, 0, 1;  // atan2(-0, -1) is -pi
  EXPECT_EQ(planar(pose).yaw, M_PI);
}

TEST_F(TrajectoryTest, SpatialUndoesPlanar) {
  const Pose2D pose{4, -3, 2.5};
  const Eigen::Isometry3d result = spatial(pose);
  EXPECT_EQ(result.translation(), Eigen::Vector3d(4, -3, 0));
  EXPECT_EQ(result.linear().col(2), Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(result.linear()(0, 0), std::cos(2.5), 1e-15);
  EXPECT_NEAR(result.linear()(1, 0), std::sin(2.5), 1e-15);
  EXPECT_NEAR(planar(result).yaw, 2.5, 1e-15);
}

TEST_F(TrajectoryTest, ReadsTumByHand) {
  const auto poses =
      readTum(write("t.tum",
                    "# time x y z qx qy qz qw\n"
                    "10.5 1 2 3 0 0 0 1\n"
                    "11 4 5 6 0 0 0.7071068 0.7071068 # a quarter turn to the left\n"));
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].time, 10.5);
  EXPECT_EQ(poses[0].pose.matrix(),
            (Eigen::Matrix4d() << 1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1).finished());
  EXPECT_TRUE(poses[1].pose.linear().isApprox(
      (Eigen::Matrix3d() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished(), 1e-7));
  const auto flat = planar(poses);
  EXPECT_EQ(flat[1].time, 11);
  EXPECT_NEAR(flat[1].pose.yaw, M_PI / 2, 1e-15);
}

TEST_F(TrajectoryTest, WritesPlanarTumByHand) {
  writeTum(path("t.tum"),
           std::vector<StampedPose2D>{{0.1, {1.5, -2, 0}}, {0.25, {0, 0, M_PI / 2}}});
  EXPECT_EQ(read(path("t.tum")),
            "0.100000000 1.500000000 -2.000000000 0.000000000 0.000000000 0.000000000 0.000000000 "
            "1.000000000\n"
            "0.250000000 0.000000000 0.000000000 0.000000000 0.000000000 0.000000000 0.707106781 "
            "0.707106781\n");
}

TEST_F(TrajectoryTest, TumComesBack) {
  std::vector<StampedPose3D> poses;
  for (int i = 0; i < 50; ++i) {
    StampedPose3D entry;
    entry.time = 1317042145.964389324 + 0.1 * i;
    entry.pose.linear() = (Eigen::AngleAxisd(0.3 * i - 6, Eigen::Vector3d::UnitZ()) *
                           Eigen::AngleAxisd(0.01 * i, Eigen::Vector3d::UnitX()))
                              .toRotationMatrix();
    entry.pose.translation() << 12.3456789012 * i, -i, 0.01 * i;
    poses.push_back(entry);
  }
  writeTum(path("t.tum"), poses);
  const auto back = readTum(path("t.tum"));
  ASSERT_EQ(back.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(back[i].time, poses[i].time);  // 9 decimals keep today's time stamps exact
    EXPECT_TRUE(back[i].pose.isApprox(poses[i].pose, 1e-8)) << i;
  }
}

TEST_F(TrajectoryTest, PlanarTumIsTheSameInThePlane) {
  const auto file = write("t.tum",
                          "# t x y z q\n1.5 10 -20 3 0 0 0 1\n\n"
                          "2 1e5 0.25 -1 0.1 0.2 0.3 0.927361849549570\n");
  const auto expected = planar(readTum(file)), read = readPlanarTum(file);
  ASSERT_EQ(read.size(), 2u);
  std::string rows;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].time, expected[i].time);
    EXPECT_EQ(read[i].pose.x, expected[i].pose.x);
    EXPECT_EQ(read[i].pose.y, expected[i].pose.y);
    EXPECT_EQ(read[i].pose.yaw, expected[i].pose.yaw);
    rows += tumRow(read[i]);
  }
  writeTum(path("u.tum"), read);
  EXPECT_EQ(test::read(path("u.tum")), rows);
  EXPECT_REFUSED(tumRow({1, {NAN, 0, 0}}), "not finite");
  EXPECT_REFUSED(readPlanarTum(write("t.tum", "1 2\n")), "t.tum:1");
}

TEST_F(TrajectoryTest, RefusesTumWithWrongColumns) {
  const fs::path file = write("t.tum", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 1\n");
  EXPECT_REFUSED(readTum(file), file.string() + ":2: ", "7 numbers", "8 expected");
}

TEST_F(TrajectoryTest, RefusesTumThatIsNoNumber) {
  const fs::path file = write("t.tum", "1 0 0 nan 0 0 0 1\n");
  EXPECT_REFUSED(readTum(file), file.string() + ":1: ", "nan");
}

TEST_F(TrajectoryTest, RefusesTumWithoutUnitQuaternion) {
  const fs::path file = write("t.tum", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1.02\n");
  EXPECT_REFUSED(readTum(file), file.string() + ":2: ", "1.02");
  const fs::path zero = write("z.tum", "1 0 0 0 0 0 0 0\n");
  EXPECT_REFUSED(readTum(zero), "length 0");
}

TEST_F(TrajectoryTest, RefusesTumWhoseTimeStandsStill) {
  const fs::path file = write("t.tum", "1.5 0 0 0 0 0 0 1\n\n1.5 0 0 0 0 0 0 1\n");
  EXPECT_REFUSED(readTum(file), file.string() + ":3: ", "1.5 is not after 1.5");
}

TEST_F(TrajectoryTest, RefusesTumWithoutPoses) {
  const fs::path file = write("t.tum", "# nothing\n");
  EXPECT_REFUSED(readTum(file), file.string(), "no pose");
}

TEST_F(TrajectoryTest, RefusesToWriteWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<StampedPose2D> poses{{0, {0, 0, 0}}, {1, {0, nan, 0}}};
  EXPECT_REFUSED(writeTum(path("t.tum"), poses), path("t.tum").string(), "pose 1");
  EXPECT_TRUE(fs::is_empty(m_folder));
}

TEST_F(TrajectoryTest, ReadsKittiPosesByHand) {
  const auto poses = readKittiPoses(write("p.txt",
                                          "1 0 0 7 0 1 0 8 0 0 1 9\n"
                                          "# turned to the left\n"
                                          "0 -1 0 1 1 0 0 2 0 0 1 3\n"));
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].linear(), Eigen::Matrix3d::Identity());
  EXPECT_EQ(poses[0].translation(), Eigen::Vector3d(7, 8, 9));
  EXPECT_TRUE((poses[1] * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 3, 3), 1e-15));
}

TEST_F(TrajectoryTest, TakesTheRoundingOutOfRotations) {
  const std::string c = "0.7071", s = c;  // off by 7e-6
  const auto poses =
      readKittiPoses(write("p.txt", c + " -" + s + " 0 1 " + s + " " + c + " 0 2 0 0 1 3\n"));
  EXPECT_TRUE((poses[0].linear().transpose() * poses[0].linear()).isIdentity(1e-15));
  EXPECT_NEAR(poses[0].linear()(0, 0), kRootHalf, 1e-15);
}

TEST_F(TrajectoryTest, RefusesPosesWithWrongColumns) {
  const fs::path file = write("p.txt", "0 -1 0 1\n");
  EXPECT_REFUSED(readKittiPoses(file), file.string() + ":1: ", "4 numbers", "12 expected");
}

TEST_F(TrajectoryTest, RefusesPosesWithoutRotation) {
  for (const char* row : {"1.01 0 0 0 0 1 0 0 0 0 1 0", "-1 0 0 0 0 1 0 0 0 0 1 0",
                          "1 0.01 0 0 0 1 0 0 0 0 1 0", "0 0 0 0 0 0 0 0 0 0 0 0"}) {
    const fs::path file = write("p.txt", std::string("1 0 0 0 0 1 0 0 0 0 1 0\n") + row + "\n");
    EXPECT_REFUSED(readKittiPoses(file), file.string() + ":2: ", "not a rotation");
  }
}

TEST_F(TrajectoryTest, RefusesAFileWithoutPoses) {
  const fs::path file = write("p.txt", "\n");
  EXPECT_REFUSED(readKittiPoses(file), file.string(), "no pose");
}

TEST_F(TrajectoryTest, ReadsTheTracksOfMulRan) {
  POLEMCL_NEEDS_DATA();
  const auto poses = readKittiPoses(dataFolder() / "tracks" / "kaist01.txt.gz");
  double length = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    length += (poses[i].translation() - poses[i - 1].translation()).norm();
  }
  EXPECT_NEAR(length, 6000, 500);  // "6 km city drives"
}

}  // namespace
}  // namespace polemcl::test_trajectory
