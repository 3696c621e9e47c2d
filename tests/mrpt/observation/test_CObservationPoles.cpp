#include <gtest/gtest.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/opengl/CCylinder.h>
#include <mrpt/opengl/CGridPlaneXY.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>

#include <cmath>
#include <sstream>

#include "support/ExpectHas.h"
#include "support/Poles.h"
#include "support/Samples.h"

namespace polemcl::test_cobservation_poles {
namespace {

void expectEqual(const CObservationPoles& a, const CObservationPoles& b) {
  EXPECT_EQ(a.timestamp, b.timestamp);
  EXPECT_EQ(a.sensorLabel, b.sensorLabel);
  EXPECT_EQ(a.sensorPose, b.sensorPose);
  EXPECT_EQ(a.visibilityRange, b.visibilityRange);
  EXPECT_EQ(a.points, b.points);
  ASSERT_EQ(a.poles.size(), b.poles.size());
  for (std::size_t i = 0; i < a.poles.size(); ++i) tests::expectSame(a.poles[i], b.poles[i]);
}

TEST(CObservationPoles, IsRegistered) {
  const auto* id = mrpt::rtti::findRegisteredClass("polemcl::CObservationPoles");
  ASSERT_NE(id, nullptr);
  EXPECT_TRUE(id->derivedFrom("mrpt::obs::CObservation"));
  EXPECT_NE(std::dynamic_pointer_cast<CObservationPoles>(
                mrpt::rtti::classFactory("polemcl::CObservationPoles")),
            nullptr);
}

TEST(CObservationPoles, SurvivesSerialization) {
  const CObservationPoles scan = samples::observation();
  const std::string bytes = samples::bytesOf(scan);
  const auto read = std::dynamic_pointer_cast<CObservationPoles>(samples::objectFrom(bytes));
  ASSERT_TRUE(read);
  expectEqual(*read, scan);
  EXPECT_EQ(samples::bytesOf(*read), bytes);
}

TEST(CObservationPoles, SurvivesInsideAFrame) {
  mrpt::obs::CSensoryFrame frame;
  frame.insert(std::make_shared<CObservationPoles>(samples::observation()));
  const auto read = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(
      samples::objectFrom(samples::bytesOf(frame)));
  ASSERT_TRUE(read);
  const auto scan = read->getObservationByClass<CObservationPoles>();
  ASSERT_TRUE(scan);
  expectEqual(*scan, samples::observation());
}

TEST(CObservationPoles, ReadingReplacesWhatWasThere) {
  CObservationPoles scan = samples::observation();
  CObservationPoles empty;
  empty.timestamp = scan.timestamp;
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  archive << empty;
  memory.Seek(0);
  archive >> scan;
  expectEqual(scan, empty);
}

TEST(CObservationPoles, RefusesNewerVersions) {
  std::string bytes = samples::bytesOf(samples::observation());
  const std::string name = "polemcl::CObservationPoles";
  ASSERT_EQ(bytes.substr(1, name.size()), name);
  ASSERT_EQ(bytes[1 + name.size()], 2);  // the current version
  bytes[1 + name.size()] = 3;
  EXPECT_ANY_THROW(samples::objectFrom(bytes));
}

TEST(CObservationPoles, ReadsOlderVersionsWithoutTimeOffsetsAndTurningRates) {
  CObservationPoles scan = samples::observation();
  std::string bytes = samples::bytesOf(scan);
  const auto expectRead = [&](char version) {
    const std::size_t dropped = scan.poles.size() * sizeof(double);
    bytes.erase(bytes.size() - 1 - dropped, dropped);  // the last byte ends the object
    bytes[1 + std::string("polemcl::CObservationPoles").size()] = version;
    const auto read = std::dynamic_pointer_cast<CObservationPoles>(samples::objectFrom(bytes));
    ASSERT_TRUE(read);
    expectEqual(*read, scan);
  };
  for (auto& pole : scan.poles) pole.turnRate = 0;
  expectRead(1);
  for (auto& pole : scan.poles) pole.timeOffset = 0;
  expectRead(0);
}

TEST(CObservationPoles, CutShortIsRefused) {
  const std::string bytes = samples::bytesOf(samples::observation());
  for (const std::size_t size : {bytes.size() - 1, bytes.size() / 2, std::size_t{40}})
    EXPECT_ANY_THROW(samples::objectFrom(bytes.substr(0, size))) << size;
}

TEST(CObservationPoles, ClonesAreIndependent) {
  CObservationPoles scan = samples::observation();
  const auto clone = std::dynamic_pointer_cast<CObservationPoles>(scan.duplicateGetSmartPtr());
  ASSERT_TRUE(clone);
  expectEqual(*clone, scan);
  scan.poles[0].x = 99;
  EXPECT_EQ(clone->poles[0].x, 5);
}

// Sensor at (1, 2), a quarter turn to the left: a point 5 m in front of it is at (1, 7) in the
// robot frame.
TEST(CObservationPoles, MovesPolesToTheRobotFrame) {
  const CObservationPoles scan = samples::observation();
  const auto poles_robot = scan.polesInRobotFrame();
  ASSERT_EQ(poles_robot.size(), 2u);
  EXPECT_NEAR(poles_robot[0].x, 1, 1e-12);
  EXPECT_NEAR(poles_robot[0].y, 7, 1e-12);
  EXPECT_NEAR(poles_robot[1].x, -3, 1e-12);
  EXPECT_NEAR(poles_robot[1].y, -1, 1e-12);
  EXPECT_NEAR(poles_robot[0].covariance(0, 0), 0.09, 1e-12);
  EXPECT_NEAR(poles_robot[0].covariance(0, 1), -0.01, 1e-12);
  EXPECT_EQ(poles_robot[0].top, 4.5);
}

/// MRPT computes the angles of a pose when they are asked for, in const functions as well.
struct PosePeek : mrpt::poses::CPose3D {
  static bool hasAngles(const mrpt::poses::CPose3D& pose) {
    return pose.*(&PosePeek::m_ypr_uptodate);
  }
};

TEST(CObservationPoles, ChangesNothingLateSoThatThreadsCanShareIt) {
  CObservationPoles turned;
  const mrpt::poses::CPose3D a(1, 2, 3, 0.1, 0.2, 0.3), b(3, 2, 1, 0.3, 0.2, 0.1);
  turned.setSensorPose(a + b);
  EXPECT_TRUE(PosePeek::hasAngles(turned.sensorPose));
  const auto read =
      std::dynamic_pointer_cast<CObservationPoles>(samples::objectFrom(samples::bytesOf(turned)));
  ASSERT_TRUE(read);
  EXPECT_TRUE(PosePeek::hasAngles(read->sensorPose));
}

// Roll and pitch do not affect the planar frame.
TEST(CObservationPoles, OnlyThePlanarPartOfTheSensorPoseCounts) {
  CObservationPoles scan = samples::observation();
  scan.setSensorPose(mrpt::poses::CPose3D(1, 2, 9, M_PI / 2, 0.1, M_PI));
  EXPECT_NEAR(scan.polesInRobotFrame()[0].y, 7, 1e-12);
}

TEST(CObservationPoles, SensorPoseInAllItsForms) {
  CObservationPoles scan;
  scan.setSensorPose(mrpt::math::TPose3D(1, 2, 3, 0.5, 0, 0));
  mrpt::poses::CPose3D pose;
  scan.getSensorPose(pose);
  EXPECT_NEAR(pose.yaw(), 0.5, 1e-12);
  mrpt::math::TPose3D flat;
  scan.getSensorPose(flat);
  EXPECT_EQ(flat.z, 3);
}

TEST(CObservationPoles, DescribesItself) {
  std::ostringstream text;
  samples::observation().getDescriptionAsText(text);
  for (const char* part :
       {"LIDAR", "polemcl::CObservationPoles", "Poles: 2", "1234", "5.000", "4.500", "0.200", "42"})
    EXPECT_HAS(text.str(), part) << part << " in\n" << text.str();
}

TEST(CObservationPoles, ExportsOneRow) {
  const CObservationPoles scan = samples::observation();
  ASSERT_TRUE(scan.exportTxtSupported());
  EXPECT_FALSE(scan.exportTxtHeader().empty());
  EXPECT_EQ(scan.exportTxtHeader().find('\n'), std::string::npos);
  EXPECT_EQ(scan.exportTxtDataRow(),
            "2 5.00000 0.00000 0.12500 0.25000 4.50000 0.75000"
            " -3.00000 4.00000 0.20000 0.25000 4.50000 0.75000");
  EXPECT_EQ(CObservationPoles().exportTxtDataRow(), "0");
}

TEST(CObservationPoles, DrawsPolesAxesGroundAndCovariances) {
  mrpt::opengl::CSetOfObjects scene;
  samples::observation().getVisualizationInto(scene);
  ASSERT_EQ(scene.size(), 6u);  // ground, axes, two poles with an ellipse each
  EXPECT_TRUE(scene.getByClass<mrpt::opengl::CGridPlaneXY>(0));
  const auto axes = scene.getByClass<mrpt::opengl::CSetOfObjects>(0);
  ASSERT_TRUE(axes);
  EXPECT_NEAR(axes->getPose().z, 1.5, 1e-6);  // at the sensor
  const auto ellipse = scene.getByClass<mrpt::opengl::CSetOfLines>(0);
  ASSERT_TRUE(ellipse);
  EXPECT_NEAR(ellipse->getPose().x, 1, 1e-6);
  // The sensor is turned by a quarter: variances 0.04 and 0.09 change places.
  double alongX = 0, alongY = 0;
  for (std::size_t i = 0; i < ellipse->getLineCount(); ++i) {
    double x0, y0, z0, x1, y1, z1;
    ellipse->getLineByIndex(i, x0, y0, z0, x1, y1, z1);
    alongX = std::max(alongX, x0);
    alongY = std::max(alongY, y0);
  }
  EXPECT_NEAR(alongX, 10 * 0.3, 0.05);
  EXPECT_NEAR(alongY, 10 * 0.2, 0.05);
  const auto cylinder = scene.getByClass<mrpt::opengl::CCylinder>(0);
  ASSERT_TRUE(cylinder);
  EXPECT_NEAR(cylinder->getPose().x, 1, 1e-6);
  EXPECT_NEAR(cylinder->getPose().y, 7, 1e-6);
  EXPECT_NEAR(cylinder->getPose().z, 0.25, 1e-6);
  EXPECT_NEAR(cylinder->getHeight(), 4.25, 1e-6);
  EXPECT_NEAR(cylinder->getTopRadius(), 0.125, 1e-6);
}

}  // namespace
}  // namespace polemcl::test_cobservation_poles
