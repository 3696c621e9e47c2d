// pole-localize takes the same memory for a drive of any length.

#include "support/LocalizeTest.h"
#include "support/MemoryTaken.h"

namespace polemcl::test_localize_memory {
namespace {

using namespace testing_apps;

constexpr std::size_t directions = 1440;  // of the visibility range: 5.8 kB a scan

class LocalizeMemory : public LocalizeTest {
 protected:
  /// The street over and over: forth, and back by driving in reverse.
  void writeDrive(std::size_t count) {
    RawlogWriter writer((folder / "in.rawlog").string());
    std::vector<StampedPose2D> truth;
    std::size_t before = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t turn = i % (2 * scans - 2), at = turn < scans ? turn : 2 * scans - 2 - turn;
      const double time = 100 + 0.1 * static_cast<double>(i);
      auto poles = CObservationPoles::Create();
      poles->timestamp = mrpt::Clock::fromDouble(time);
      poles->poles = street.frames[at].poles_robot;
      poles->points = 1000;
      poles->visibilityRange.assign(directions, 20.0f);
      PoseWithCovariance motion;
      motion.mean = relative(street.truth[before], street.truth[at]);
      motion.covariance = 1e-4 * Eigen::Matrix3d::Identity();
      writer.write(makeActions(motion, poles->timestamp), poles);
      truth.push_back({time, street.truth[at]});
      before = at;
    }
    writer.commit();
    io::writeTum(folder / "truth.tum", truth);
  }
  /// Bytes of the heap that were in use at the same time, at most, beyond those before.
  std::int64_t peakOf(std::size_t count) {
    writeDrive(count);
    const std::size_t peak = tests::memoryTakenBy([&] {
      const Outcome outcome = succeeded(runWithTruth({"--runs", "2", "--particles", "50"}));
    });
    EXPECT_EQ(summary()["poses"], count);
    return static_cast<std::int64_t>(peak);
  }
};

// What grows is the truth: 32 bytes a pose, and up to twice that again while its vector grows.
TEST_F(LocalizeMemory, DoesNotGrowWithTheDrive) {
  peakOf(100);  // what libraries keep from the first run on
  const std::int64_t few = peakOf(300), many = peakOf(3000);
  EXPECT_LT(many - few, 2700 * 96 + 100000);
  EXPECT_GT(few, 100000);  // something was counted
}

}  // namespace
}  // namespace polemcl::test_localize_memory
