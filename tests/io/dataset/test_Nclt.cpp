#include "io/data/Trajectory.h"
#include "io/dataset/Nclt.h"
#include "io/dataset/NcltOdometry.h"
#include "support/IoFiles.h"
#include "support/NcltSamples.h"

namespace polemcl::test_nclt {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;
using namespace testing_nclt;

constexpr std::uint64_t kPeriod = 200000;  ///< us between scans

std::uint64_t scanTime(int i) {
  return start + static_cast<std::uint64_t>(i) * kPeriod;
}

/// Five scans 0.2 s apart; the body goes north at 5 m/s, z down, with a heading of 0.1 rad.
class NcltTest : public FolderTest {
 protected:
  void SetUp() override {
    for (int i = 0; i < 5; ++i)
      write("2012-01-15/velodyne_sync/" + std::to_string(scanTime(i)) + ".bin", point(1, 2, 3));
    std::string truth = std::to_string(start - 20000) + ",nan,nan,nan,nan,nan,nan\n", track, steps,
                covariances;
    Eigen::Matrix<double, 6, 6> c = Eigen::Matrix<double, 6, 6>::Zero();
    c.diagonal() << 0.04, 0.01, 1, 1, 1, 0.0025;
    c(0, 1) = c(1, 0) = 0.005;
    c(0, 5) = c(5, 0) = 0.002;
    for (int i = -2; i < 110; ++i) {
      const std::uint64_t t = start + static_cast<std::uint64_t>(i + 2) * 10000 - 20000;
      truth += poseRow(t, 100 + 0.05 * i, 200, -3, 0, 0, 0.1);
      track += poseRow(t, 0.05 * i * std::cos(0.4), 0.05 * i * std::sin(0.4), 0, 0, 0, 0.4);
    }
    for (int i = -1; i < 6; ++i) {  // steps of 0.2 s, half a period before the scans
      const std::uint64_t t = start + static_cast<std::uint64_t>(i + 1) * kPeriod - kPeriod / 2;
      steps += poseRow(t, 1, 0, 0, 0, 0, 0);
      covariances += covarianceRow(t, c);
    }
    write("2012-01-15/groundtruth_2012-01-15.csv", truth);
    write("2012-01-15/odometry_mu_100hz.csv", track);
    write("2012-01-15/odometry_mu.csv", steps);
    write("2012-01-15/odometry_cov.csv", covariances);
  }
  ScanFolder load() const { return readNclt(path("2012-01-15"), ncltRobotBody()); }
  std::string notes(const ScanFolder& folder) const {
    std::string all;
    for (const std::string& note : folder.notes) all += note + "; ";
    return all;
  }
  void remove(const std::string& name) const { fs::remove_all(path("2012-01-15/" + name)); }
};

TEST_F(NcltTest, MapIsEastNorthUpAndTheRobotUpright) {
  const ScanFolder session = load();
  ASSERT_EQ(session.scans.size(), 5u);
  for (int i = 0; i < 5; ++i) {
    const ScanEntry& scan = session.scans[static_cast<std::size_t>(i)];
    EXPECT_NEAR(scan.time, scanTime(i) * 1e-6, 1e-6);
    // North 100 + i, east 200, 3 m up (z down in the file).
    EXPECT_TRUE(scan.T_map_robot->translation().isApprox(Eigen::Vector3d(200, 100 + i, 3), 1e-6));
    // The compass heading 0.1 from north to east is π/2 − 0.1 from east to north.
    EXPECT_NEAR(planar(*scan.T_map_robot).yaw, M_PI / 2 - 0.1, 1e-6);
    EXPECT_NEAR(scan.T_map_robot->linear()(2, 2), 1, 1e-9);  // z up
  }
  expectIn(notes(session), ".csv: 1 rows ignored: not finite");
}

TEST_F(NcltTest, MotionsAreThoseOfTheTrackWithTheCovariancesOfTheSteps) {
  const ScanFolder session = load();
  EXPECT_FALSE(session.scans[0].motion);
  const PoseWithCovariance& motion = *session.scans[2].motion;
  EXPECT_NEAR(motion.mean.x, 1, 1e-6);  // forward
  EXPECT_NEAR(motion.mean.y, 0, 1e-6);
  // Half of one step and half of the next. Computed by hand, with y and heading negated (z up). The
  // heading error of the first half moves the end by 0.5 m per radian; half of each covariance
  // counts.
  const double xx = 0.04, xy = -0.005, yy = 0.01, xh = -0.002, hh = 0.0025, floor = 1e-6;
  EXPECT_NEAR(motion.covariance(0, 0), xx + floor, 2e-7);
  EXPECT_NEAR(motion.covariance(0, 1), xy + 0.5 * xh / 2, 2e-7);
  EXPECT_NEAR(motion.covariance(0, 2), xh, 2e-7);
  EXPECT_NEAR(motion.covariance(1, 1), yy + 0.25 * hh / 2 + floor, 2e-7);
  EXPECT_NEAR(motion.covariance(2, 2), hh + 1e-8, 2e-7);
}

TEST_F(NcltTest, TurnsToTheRightAreNegative) {
  std::string track;
  for (int i = 0; i < 110; ++i)
    track += poseRow(start + static_cast<std::uint64_t>(i) * 10000, 0, 0, 0, 0, 0, 0.005 * i);
  write("2012-01-15/odometry_mu_100hz.csv", track);
  EXPECT_NEAR(load().scans[1].motion->mean.yaw, -0.1, 1e-6);
}

TEST_F(NcltTest, StepsAloneAreJoined) {
  remove("odometry_mu_100hz.csv");
  const ScanFolder session = load();
  ASSERT_EQ(session.scans.size(), 5u);
  EXPECT_NEAR(session.scans[3].motion->mean.x, 1, 1e-6);
}

TEST_F(NcltTest, WithoutCovariancesTheMotionGivesThem) {
  remove("odometry_cov.csv");
  const ScanFolder session = load();
  EXPECT_NEAR(session.scans[1].motion->covariance(0, 0), 0.05 * 0.05 + 1e-6, 2e-7);
  expectIn(notes(session), "odometry_cov.csv", "5 %");
}

TEST_F(NcltTest, FilesMayBeMissing) {
  for (const char* name :
       {"odometry_mu_100hz.csv", "odometry_mu.csv", "groundtruth_2012-01-15.csv"})
    remove(name);
  const ScanFolder session = load();
  ASSERT_EQ(session.scans.size(), 5u);
  EXPECT_FALSE(session.scans[1].motion);
  EXPECT_FALSE(session.scans[0].T_map_robot);
  expectIn(notes(session), "no groundtruth_DATE.csv");
}

TEST_F(NcltTest, TheTruthMayLieBesideTheSession) {
  fs::rename(path("2012-01-15/groundtruth_2012-01-15.csv"), path("groundtruth_2012-01-15.csv"));
  write("groundtruth_2012-01-22.csv", "1,2\n");
  EXPECT_TRUE(load().scans[0].T_map_robot);
}

TEST_F(NcltTest, PartsMayLieOneFolderBelow) {
  fs::create_directories(path("2012-01-15/sen"));
  fs::rename(path("2012-01-15/odometry_mu.csv"), path("2012-01-15/sen/odometry_mu.csv"));
  EXPECT_NEAR(load().scans[2].motion->covariance(2, 2), 0.0025 + 1e-8, 2e-7);
}

TEST_F(NcltTest, ScansRightInTheFolderAreFound) {
  fs::rename(path("2012-01-15/velodyne_sync"), path("bare"));
  EXPECT_EQ(readNclt(path("bare"), ncltRobotBody()).scans.size(), 5u);
}

TEST_F(NcltTest, ScansWithoutTruthOrOdometryAreLeftOut) {
  write("2012-01-15/velodyne_sync/" + std::to_string(scanTime(-10)) + ".bin", point(1, 2, 3));
  std::string truth;  // no rows at scan 1 and after scan 3
  truth += poseRow(start - 900000, 0, 0, 0, 0, 0, 0) + poseRow(start, 0, 0, 0, 0, 0, 0) +
           poseRow(scanTime(2), 2, 0, 0, 0, 0, 0) + poseRow(scanTime(3), 3, 0, 0, 0, 0, 0);
  write("2012-01-15/groundtruth_2012-01-15.csv", truth);
  const ScanFolder session = load();
  ASSERT_EQ(session.scans.size(), 4u);  // 0.4 s are not a gap
  EXPECT_NEAR(session.scans[1].T_map_robot->translation().y(), 1, 1e-5);
  expectIn(notes(session), "1 of 6 scans left out, at times without odometry",
           "1 of 5 scans left out, at times without truth");
}

TEST_F(NcltTest, TellsHowGoodTheTruthIs) {
  Eigen::Matrix<double, 6, 6> c = Eigen::Matrix<double, 6, 6>::Zero();
  c(0, 0) = 0.09;
  c(1, 1) = 0.16;
  write("2012-01-15/cov_2012-01-15.csv",
        covarianceRow(start, c / 25) + covarianceRow(scanTime(1), c) + covarianceRow(1, 100 * c));
  expectIn(notes(load()), "0.300 m in the mean, 0.500 m at worst (cov_2012-01-15.csv)");
}

TEST_F(NcltTest, ReadsPacketsWhereThereAreNoScans) {
  remove("velodyne_sync");
  // Revolutions of 0.36 s; the body moves 1.8 m in each.
  write("2012-01-15/velodyne_hits.bin", turning(80, 10.005));
  const ScanFolder session = load();
  ASSERT_EQ(session.scans.size(), 2u);
  EXPECT_NEAR(session.scans[0].time, start * 1e-6 + 0.175, 1e-5);
  EXPECT_NEAR(session.scans[1].motion->mean.x, 1.8, 1e-5);
  EXPECT_NEAR(session.scans[1].T_map_robot->translation().y(), 100 + 5 * 0.535, 1e-4);
  // The first point, 10 m to the left of the body, is farther back at the middle of the revolution.
  const Cloud cloud = session.read(session.scans[1]);
  ASSERT_EQ(cloud.size(), 36u);
  EXPECT_NEAR(cloud.x[0], -0.12 - 5 * 0.175, 0.02);
  EXPECT_NEAR(cloud.y[0], -10, 0.02);
}

TEST_F(NcltTest, RefusesTimesThatDoNotOverlap) {
  write("2012-01-15/groundtruth_2012-01-15.csv",
        poseRow(1000000, 0, 0, 0, 0, 0, 0) + poseRow(2000000, 0, 0, 0, 0, 0, 0));
  EXPECT_REFUSED(load(), "groundtruth_2012-01-15.csv", "no truth", "1.000 ... 2.000 s",
                 "scans 1326652795.000 ... 1326652795.800 s");
  write("2012-01-15/odometry_mu_100hz.csv",
        poseRow(1000000, 0, 0, 0, 0, 0, 0) + poseRow(2000000, 0, 0, 0, 0, 0, 0));
  EXPECT_REFUSED(load(), "odometry_mu_100hz.csv", "no odometry", "1.000 ... 2.000 s");
  write("2012-01-15/odometry_mu_100hz.csv", "");
  EXPECT_REFUSED(load(), "odometry_mu_100hz.csv", "no odometry", "none");
}

TEST_F(NcltTest, RefusesSessionsWithoutScans) {
  remove("velodyne_sync");
  EXPECT_REFUSED(load(), "2012-01-15", "velodyne_sync", "velodyne_hits.bin", "_vel.tar.gz");
  EXPECT_REFUSED(readNclt(path("no"), ncltRobotBody()), path("no").string());
}

TEST_F(NcltTest, RefusesShortRowsAndCutScans) {
  const std::string scan = "2012-01-15/velodyne_sync/" + std::to_string(scanTime(2)) + ".bin";
  write(scan, point(1, 2, 3) + "abc");
  EXPECT_REFUSED(load(), std::to_string(scanTime(2)), "cut short: 11 bytes", "multiple of 8");
  write(scan, point(1, 2, 3));
  write("2012-01-15/groundtruth_2012-01-15.csv", "1,2,3,4,5,6,7\n2,3,4\n");
  EXPECT_REFUSED(load(), "groundtruth_2012-01-15.csv:2: ", "3 numbers, 7 expected");
  write("2012-01-15/odometry_cov.csv", "1,2\n");
  EXPECT_REFUSED(load(), "odometry_cov.csv:1: ", "2 numbers, 22 expected");
}

// The mean continues to come from odometry_mu.csv.
TEST_F(NcltTest, CovariancesOfOtherTimesAreDoneWithout) {
  write("2012-01-15/odometry_cov.csv", covarianceRow(5, Eigen::Matrix<double, 6, 6>::Identity()));
  const ScanFolder session = load();
  EXPECT_NEAR(session.scans[2].motion->mean.x, 1, 1e-6);
  EXPECT_NEAR(session.scans[2].motion->covariance(0, 0), 0.05 * 0.05 + 1e-6, 2e-7);
  expectIn(notes(session), "rows of odometry_cov.csv and odometry_mu.csv do not match",
           "of 6 motions 0 take", "6 have none");
}

TEST_F(NcltTest, CovariancesAreFoundByTheirTimes) {
  // As in the original files: rows that are missing in odometry_mu.csv, missing rows, times
  // slightly off, not in order, not finite.
  const auto c = [](double xx) {
    Eigen::Matrix<double, 6, 6> all = Eigen::Matrix<double, 6, 6>::Zero();
    all.diagonal() << xx, 0.01, 1, 1, 1, 0.0025;
    return all;
  };
  const auto stepTime = [](int i) { return scanTime(i) - kPeriod / 2; };
  std::string rows = covarianceRow(stepTime(0) - 90 * kPeriod, c(9));
  rows += covarianceRow(stepTime(1) - 3000, c(0.04));  // 3 ms early
  rows += covarianceRow(stepTime(1) + 97000, c(7));    // between two steps
  rows += covarianceRow(stepTime(2) + 5000, c(0.16));  // 5 ms late
  rows += covarianceRow(stepTime(1), c(8));            // out of order
  rows += covarianceRow(stepTime(3), c(std::nan("")));
  rows += covarianceRow(stepTime(5), c(0.36));
  write("2012-01-15/odometry_cov.csv", rows);
  const ScanFolder session = load();
  // From scan 0 to 1: half of the first step and half of the second.
  EXPECT_NEAR(session.scans[1].motion->covariance(0, 0), (0.04 + 0.16) / 2 + 1e-6, 1e-3);
  // From scan 2 to 3: neither of the two steps has a covariance.
  EXPECT_NEAR(session.scans[3].motion->covariance(0, 0), 0.05 * 0.05 + 1e-6, 2e-7);
  expectIn(notes(session), "of 6 motions 2 take the covariance of the nearest time, 3 have none");
}

TEST_F(NcltTest, RefusesSeveralSessionsInOneFolder) {
  fs::copy(path("2012-01-15"), path("2012-01-22"), fs::copy_options::recursive);
  EXPECT_REFUSED(readNclt(m_folder, ncltRobotBody()), "several of these", "2012-01-15",
                 "2012-01-22");
}

TEST_F(NcltTest, TakesPositionsFromSatellites) {
  EXPECT_TRUE(load().fixes.empty());
  std::string rows;
  for (const int mode : {3, 1, 0, 2})
    rows += std::to_string(scanTime(mode)) + "," + std::to_string(mode) +
            ",7,0.738,-1.461,270.5,nan,0.1\n";
  write("2012-01-15/gps.csv", rows + std::to_string(start) + ",3,7,nan,nan,nan,nan,nan\n");
  const ScanFolder session = load();
  expectIn(notes(session), "gps.csv: 2 positions from satellites");
  ASSERT_EQ(session.fixes.size(), 2u);
  EXPECT_NEAR(session.fixes[0].time, scanTime(2) * 1e-6, 1e-6);
  EXPECT_NEAR(session.fixes[0].latitude, 42.284285, 1e-6);
  EXPECT_NEAR(session.fixes[0].longitude, -83.709134, 1e-6);
  EXPECT_EQ(session.fixes[0].sigma, 2.5);
  EXPECT_NEAR(session.fixes[1].time, scanTime(3) * 1e-6, 1e-6);
  write("2012-01-15/gps.csv", "1,3,7,0.7\n");
  EXPECT_REFUSED(load(), "gps.csv:1: ", "4 numbers, 8 expected");
}

}  // namespace
}  // namespace polemcl::test_nclt
