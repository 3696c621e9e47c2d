#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include "mrpt/rawlog/RawlogReader.h"
#include "mrpt/rawlog/RawlogWriter.h"
#include "support/IoFiles.h"
#include "support/Samples.h"

namespace polemcl::test_rawlog_writer {
namespace {

using namespace mrpt::obs;

CActionCollection move(CActionRobotMovement2D::TEstimationMethod method) {
  CActionRobotMovement2D movement;
  movement.estimationMethod = method;
  mrpt::math::CMatrixDouble33 C;
  C.setDiagonal(std::vector<double>{0.01, 0.02, 0.003});
  C(0, 1) = C(1, 0) = 0.005;
  movement.poseChange =
      mrpt::poses::CPosePDFGaussian::Create(mrpt::poses::CPose2D(1, -0.5, 0.25), C);
  CActionCollection actions;
  actions.insert(movement);
  return actions;
}

TEST(RawlogWriter, TheCommentIsThatOfMrpt) {
  const testing_apps::TempFolder folder;
  RawlogWriter writer(folder / "s.rawlog");
  writer.writeComment("said", 12.5);
  writer.write(samples::observation());
  writer.commit();
  RawlogReader reader(folder / "s.rawlog");
  RawlogEntry entry;
  ASSERT_TRUE(reader.next(entry));
  EXPECT_TRUE(entry.observation);
  EXPECT_EQ(reader.comment(), "said");
  CRawlog log;
  ASSERT_TRUE(log.loadFromRawLogFile(folder / "s.rawlog"));
  EXPECT_EQ(log.getCommentText(), "said");
  EXPECT_EQ(log.size(), 1u);
  mrpt::io::CFileGZInputStream file(folder / "s.rawlog");
  const auto comment = std::dynamic_pointer_cast<mrpt::obs::CObservationComment>(
      mrpt::serialization::archiveFrom(file).ReadObject());
  ASSERT_TRUE(comment);
  EXPECT_NEAR(mrpt::Clock::toDouble(comment->timestamp), 12.5, 1e-6);
}

TEST(RawlogWriter, PairsAndObservationsSurvive) {
  const testing_apps::TempFolder folder;
  RawlogWriter writer(folder / "s.rawlog");
  writer.write(move(CActionRobotMovement2D::emScan2DMatching),
               std::make_shared<CObservationPoles>(samples::observation()));
  writer.write(samples::observation());
  EXPECT_FALSE(std::filesystem::exists(folder / "s.rawlog"));
  writer.commit();

  RawlogReader reader(folder / "s.rawlog");
  RawlogEntry entry;
  ASSERT_TRUE(reader.next(entry));
  ASSERT_TRUE(entry.action && entry.frame);
  const auto pose = entry.action->getBestMovementEstimation()->poseChange;
  const auto [C, mean] = pose->getCovarianceAndMean();
  EXPECT_EQ(mean.x(), 1);
  EXPECT_EQ(mean.y(), -0.5);
  EXPECT_EQ(mean.phi(), 0.25);
  EXPECT_EQ(C(1, 1), 0.02);
  EXPECT_EQ(C(0, 1), 0.005);
  EXPECT_EQ(entry.frame->getObservationByClass<CObservationPoles>()->poles.size(), 2u);
  ASSERT_TRUE(reader.next(entry));
  EXPECT_TRUE(entry.observation);
  EXPECT_FALSE(reader.next(entry));

  EXPECT_EQ(reader.comment(), "");

  CRawlog log;  // MRPT's own reader too
  ASSERT_TRUE(log.loadFromRawLogFile(folder / "s.rawlog"));
  EXPECT_EQ(log.size(), 3u);
}

// The pitfall: a motion written as emOdometry is read back with another mean and covariance.
TEST(RawlogWriter, RefusesMovementsThatWouldBeLost) {
  const testing_apps::TempFolder folder;
  CActionCollection odometry = move(CActionRobotMovement2D::emOdometry);
  const auto read =
      std::dynamic_pointer_cast<CActionCollection>(samples::objectFrom(samples::bytesOf(odometry)));
  EXPECT_EQ(read->getBestMovementEstimation()->poseChange->getMeanVal().x(), 0);

  RawlogWriter writer(folder / "s.rawlog");
  EXPECT_THROW(writer.write(odometry, std::make_shared<CObservationPoles>()), Error);
  EXPECT_THROW(writer.write(CActionCollection(), nullptr), Error);
}

TEST(RawlogWriter, LeavesNothingUnlessCommitted) {
  const testing_apps::TempFolder folder;
  { RawlogWriter(folder / "s.rawlog").write(samples::observation()); }
  EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
}

TEST(RawlogWriter, SameBytesEachTime) {
  const testing_apps::TempFolder folder;
  std::string first;
  for (const char* name : {"a", "b"}) {
    RawlogWriter writer(folder / name);
    writer.write(move(CActionRobotMovement2D::emScan2DMatching),
                 std::make_shared<CObservationPoles>(samples::observation()));
    writer.commit();
    const std::string bytes = testing_apps::readText(folder / name);
    if (first.empty()) first = bytes;
    EXPECT_EQ(bytes, first);
  }
}

TEST(RawlogWriter, RefusesAFolderThatIsNotThere) {
  EXPECT_THROW(RawlogWriter("/no/such/folder/s.rawlog"), Error);
}

// A limit on file sizes simulates a full disk: writes fail in the middle of the file.
TEST(RawlogWriter, ReportsAFullDisk) {
  const testing_apps::TempFolder folder;
  int written = 0;
  const std::string error = tests::messageOf([&] {
    const io::test::FileSizeLimit limit(20000);
    RawlogWriter writer(folder / "s.rawlog");
    for (; written < 1000; ++written) writer.write(samples::observation());
    writer.commit();
  });
  EXPECT_HAS(error, "s.rawlog");
  EXPECT_LT(written, 1000);  // noticed before the end
  EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
}

}  // namespace
}  // namespace polemcl::test_rawlog_writer
