#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/poses/CPoseRandomSampler.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <functional>

#include "mrpt/filter/MotionAction.h"
#include "support/Refusal.h"

namespace polemcl::test_motion_action {
namespace {

PoseWithCovariance usual() {
  PoseWithCovariance motion;
  motion.mean = {0.5, -0.1, 0.2};
  motion.covariance << 0.04, -0.01, 0.004, -0.01, 0.02, 0.001, 0.004, 0.001, 0.0009;
  return motion;
}

FilterOptions extra(double metres, double radians) {
  FilterOptions options;
  options.extraSigma = metres;
  options.extraSigmaYaw = radians;
  return options;
}

/// The error message for a motion changed by `change`; empty if the motion is accepted.
std::string refusal(const std::function<void(PoseWithCovariance&)>& change) {
  PoseWithCovariance motion = usual();
  change(motion);
  return tests::messageOf([&] { makeMotionAction(motion, {}); });
}

TEST(MotionAction, CarriesMeanAndCovarianceAlsoThroughAFile) {
  const auto action = makeMotionAction(usual(), extra(0.1, 0.02));
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  archive << *action;
  memory.Seek(0);
  mrpt::obs::CActionCollection stored;
  archive >> stored;
  for (const auto* collection : {action.get(), &stored}) {
    const auto movement = collection->getBestMovementEstimation();
    ASSERT_TRUE(movement);
    const auto gaussian =
        std::dynamic_pointer_cast<mrpt::poses::CPosePDFGaussian>(movement->poseChange.get_ptr());
    ASSERT_TRUE(gaussian);
    EXPECT_EQ(gaussian->mean.x(), 0.5);
    EXPECT_EQ(gaussian->mean.y(), -0.1);
    EXPECT_NEAR(gaussian->mean.phi(), 0.2, 1e-15);
    EXPECT_NEAR(gaussian->cov(0, 0), 0.05, 1e-9);
    EXPECT_NEAR(gaussian->cov(1, 1), 0.03, 1e-9);
    EXPECT_NEAR(gaussian->cov(2, 2), 0.0013, 1e-9);
    EXPECT_NEAR(gaussian->cov(0, 1), -0.01, 1e-12);
    EXPECT_NEAR(gaussian->cov(2, 0), 0.004, 1e-12);
  }
}

TEST(MotionAction, TakesNoCovarianceAtAll) {
  PoseWithCovariance motion;
  EXPECT_NO_THROW(makeMotionAction(motion, extra(0, 0)));
}

TEST(MotionAction, SamplesOfSingularCovariancesAreFinite) {
  // Rank one: rounding may make eigenvalues negative, and their roots NaN.
  for (int i = 1; i <= 500; ++i) {
    PoseWithCovariance motion;
    const Eigen::Vector3d direction(std::sin(i), std::cos(2 * i), 0.1 * std::sin(3 * i));
    motion.covariance = direction * direction.transpose();
    const auto action = makeMotionAction(motion, extra(0, 0));
    mrpt::poses::CPoseRandomSampler sampler;
    sampler.setPosePDF(*action->getBestMovementEstimation()->poseChange);
    mrpt::poses::CPose2D sample;
    sampler.drawSample(sample);
    ASSERT_TRUE(std::isfinite(sample.x()) && std::isfinite(sample.phi())) << i;
  }
}

TEST(MotionAction, RefusesWhatIsNotFinite) {
  const double bad[] = {NAN, INFINITY, -INFINITY};
  for (double value : bad) {
    EXPECT_HAS(refusal([&](auto& m) { m.mean.x = value; }), "not finite");
    EXPECT_HAS(refusal([&](auto& m) { m.mean.y = value; }), "not finite");
    EXPECT_HAS(refusal([&](auto& m) { m.mean.yaw = value; }), "not finite");
    EXPECT_HAS(refusal([&](auto& m) { m.covariance(1, 2) = value; }), "not finite");
  }
}

TEST(MotionAction, RefusesBadInput) {
  EXPECT_HAS(refusal([](auto& m) { m.mean.x = 8000, m.mean.y = -8000; }), "11313.7 m long");
  EXPECT_EQ(refusal([](auto& m) { m.mean.x = 9999; }), "no error");
  EXPECT_EQ(refusal([](auto& m) { m.mean.yaw = -999; }), "no error");
  EXPECT_HAS(refusal([](auto& m) { m.mean.yaw = 1e200; }), "turns by 1e+200 rad; at most 1000 rad");
  EXPECT_HAS(refusal([](auto& m) { m.covariance(0, 1) += 1e-6; }), "not symmetric");
  EXPECT_HAS(refusal([](auto& m) { m.covariance(1, 1) = -0.02; }), "negative eigenvalue");
  // Positive variances, but a correlation greater than one.
  EXPECT_HAS(refusal([](auto& m) { m.covariance(0, 1) = m.covariance(1, 0) = 0.03; }),
             "negative eigenvalue");
}

TEST(MotionAction, RefusesAHugeCovariance) {
  const auto sigma = [](int i, double value) {
    return [=](PoseWithCovariance& m) {
      m.covariance.setZero();
      m.covariance(i, i) = value * value;
    };
  };
  EXPECT_EQ(refusal(sigma(0, 9.99)), "no error");
  EXPECT_EQ(refusal(sigma(2, 0.99)), "no error");
  EXPECT_HAS(refusal(sigma(0, 10.01)), "too uncertain");
  EXPECT_HAS(refusal(sigma(1, 10.01)), "too uncertain");
  EXPECT_HAS(refusal(sigma(2, 1.01)), "too uncertain");
}

}  // namespace
}  // namespace polemcl::test_motion_action
