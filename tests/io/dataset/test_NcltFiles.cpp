// Folders of NCLT sessions, as left by the downloader and by its archives.

#include "io/dataset/Nclt.h"
#include "support/IoFiles.h"
#include "support/NcltSamples.h"

namespace polemcl::test_nclt_files {
namespace {

using namespace polemcl::io;
using namespace polemcl::io::test;
using namespace testing_nclt;

constexpr double kAhead = 2;  ///< length of every motion, m; each has its own covariance

/// Sessions of two scans, in folders that a test chooses.
class NcltLayout : public FolderTest {
 protected:
  /// Scans, odometry and truth; `north` distinguishes the truths of the sessions.
  void put(const std::string& velodyne, const std::string& sensors, const std::string& truth,
           const std::string& date, double north) const {
    Eigen::Matrix<double, 6, 6> c = Eigen::Matrix<double, 6, 6>::Identity();
    std::string poses, steps, covariances;
    for (int i = 0; i < 2; ++i) {
      const std::uint64_t time = start + static_cast<std::uint64_t>(i) * 200000;
      write(velodyne + "/velodyne_sync/" + std::to_string(time) + ".bin", point(1, 2, 3));
      poses += poseRow(time, north + i, 0, 0, 0, 0, 0);
      steps += poseRow(time, kAhead, 0, 0, 0, 0, 0);
      covariances += covarianceRow(time, 0.04 * c);
    }
    write(sensors + "/odometry_mu.csv", steps);
    write(sensors + "/odometry_cov.csv", covariances);
    write(truth + "/groundtruth_" + date + ".csv", poses);
    write(truth + "_cov/cov_" + date + ".csv", covariances);
  }
  ScanFolder load(const std::string& session) const {
    return readNclt(path(session), ncltRobotBody());
  }
  void expectWhole(const std::string& session, double north) const {
    SCOPED_TRACE(session);
    EXPECT_TRUE(isNcltSession(path(session)));
    const ScanFolder found = load(session);
    ASSERT_EQ(found.scans.size(), 2u);
    EXPECT_NEAR(found.scans[1].T_map_robot->translation().y(), north + 1, 1e-6);
    EXPECT_NEAR(found.scans[1].motion->mean.x, kAhead, 1e-6);
    EXPECT_NEAR(found.scans[1].motion->covariance(0, 0), 0.04, 1e-4);
    std::string notes;
    for (const std::string& note : found.notes) notes += note + "; ";
    expectIn(notes, "the truth's own standard deviation");
  }
};

// DATE_vel.tar.gz holds DATE/velodyne_sync/…, DATE_sen.tar.gz holds DATE/odometry_mu.csv, …
TEST_F(NcltLayout, ArchivesUnpackedWhereTheDownloaderPutsThem) {
  for (const auto& [date, north] : {std::pair{"2012-01-08", 100.0}, {"2012-01-15", 200.0}})
    put(std::string("nclt/velodyne_data/") + date, std::string("nclt/sensor_data/") + date,
        "nclt/ground_truth", date, north);
  expectWhole("nclt/2012-01-08", 100);
  expectWhole("nclt/2012-01-15", 200);
  expectWhole("nclt/velodyne_data/2012-01-15", 200);
  expectWhole("nclt/velodyne_data/2012-01-15/.", 200);
  const fs::path truth = path("nclt/ground_truth/groundtruth_2012-01-15.csv");
  writeGzip(truth.string() + ".gz", read(truth));
  fs::remove(truth);
  expectWhole("nclt/2012-01-15", 200);
  EXPECT_REFUSED(load("nclt"), "several sessions", "--session", "2012-01-08, 2012-01-15");
  EXPECT_REFUSED(load("nclt/2012-01-22"), path("nclt/2012-01-22").string(), "no such folder",
                 "velodyne_data");
  EXPECT_FALSE(isNcltSession(path("nclt/2012-01-22")));
}

// As on the disks of the paper's authors.
TEST_F(NcltLayout, ArchivesUnpackedInFoldersOfTheirNames) {
  put("nclt/velodyne_data/2012-01-08_vel", "nclt/sensor_data/2012-01-08_sen", "nclt/ground_truth",
      "2012-01-08", 100);
  expectWhole("nclt/2012-01-08", 100);
  expectWhole("nclt/velodyne_data/2012-01-08_vel", 100);
  expectWhole("nclt", 100);  // there is only one
  fs::create_directories(path("nclt/velodyne_data/2012-01-15_vel/2012-01-15"));
  fs::rename(path("nclt/velodyne_data/2012-01-08_vel/velodyne_sync"),
             path("nclt/velodyne_data/2012-01-15_vel/2012-01-15/velodyne_sync"));
  write("nclt/ground_truth/groundtruth_2012-01-15.csv",
        poseRow(start, 7, 0, 0, 0, 0, 0) + poseRow(start + 200000, 8, 0, 0, 0, 0, 0));
  EXPECT_NEAR(load("nclt/2012-01-15").scans[1].T_map_robot->translation().y(), 8, 1e-6);
}

// Both archives unpacked beside the downloader's folders share one folder per session.
TEST_F(NcltLayout, ArchivesUnpackedInTheRoot) {
  put("nclt/2012-01-08", "nclt/2012-01-08", "nclt/ground_truth", "2012-01-08", 100);
  write("nclt/velodyne_data/2012-01-08_vel.tar.gz", "");
  expectWhole("nclt/2012-01-08", 100);
  expectWhole("nclt", 100);
}

// The truth of another session must not be used.
TEST_F(NcltLayout, TakesNoTruthOfAnotherDate) {
  put("nclt/velodyne_data/2012-01-08", "nclt/sensor_data/2012-01-08", "nclt/ground_truth",
      "2012-01-15", 100);
  const ScanFolder found = load("nclt/2012-01-08");
  EXPECT_FALSE(found.scans[0].T_map_robot);
  EXPECT_TRUE(found.scans[1].motion);
}

TEST_F(NcltLayout, SaysWhatIsNotUnpacked) {
  write("nclt/velodyne_data/2012-01-08_vel.tar.gz", "");
  for (const char* session : {"nclt", "nclt/2012-01-08"})
    EXPECT_REFUSED(load(session), "2012-01-08_vel.tar.gz", "unpack it there");
  fs::remove(path("nclt/velodyne_data/2012-01-08_vel.tar.gz"));
  EXPECT_REFUSED(load("nclt"), "velodyne_data", "no session in it");
}

}  // namespace
}  // namespace polemcl::test_nclt_files
