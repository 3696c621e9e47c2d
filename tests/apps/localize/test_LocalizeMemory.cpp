/// \file test_LocalizeMemory.cpp
/// \brief pole-localize takes the same memory for a drive of any length.

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "support/LocalizeTest.h"

namespace {

std::atomic<std::int64_t> heldBytes{0}, mostHeld{0};

void* counted(std::size_t size) {
  void* memory = std::malloc(size);
  if (!memory) throw std::bad_alloc();
  const std::int64_t now = heldBytes += static_cast<std::int64_t>(malloc_usable_size(memory));
  std::int64_t most = mostHeld;
  while (most < now && !mostHeld.compare_exchange_weak(most, now)) {
  }
  return memory;
}

void release(void* memory) {
  heldBytes -= static_cast<std::int64_t>(malloc_usable_size(memory));
  std::free(memory);
}

}  // namespace

// These operators replace those of this test program and of the libraries it loads.
void* operator new(std::size_t size) {
  return counted(size);
}
void* operator new[](std::size_t size) {
  return counted(size);
}
void operator delete(void* memory) noexcept {
  release(memory);
}
void operator delete[](void* memory) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  release(memory);
}

namespace polemcl::test_localize_memory {

using namespace testing_apps;

namespace {

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
      io::PlanarMotion motion;
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
    const std::int64_t before = heldBytes;
    mostHeld = before;
    const auto outcome = runWithTruth({"--runs", "2", "--particles", "50"});
    const std::int64_t peak = mostHeld - before;
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(summary()["poses"], count);
    return peak;
  }
};

}  // namespace

// What grows is the truth: 32 bytes a pose, and up to twice that again while its vector grows.
TEST_F(LocalizeMemory, DoesNotGrowWithTheDrive) {
  peakOf(100);  // what libraries keep from the first run on
  const std::int64_t few = peakOf(300), many = peakOf(3000);
  EXPECT_LT(many - few, 2700 * 96 + 100000);
  EXPECT_GT(few, 100000);  // something was counted
}

}  // namespace polemcl::test_localize_memory
