// What the extractor may and may not depend on: the instruction set, and the heap.

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "support/KnownScene.h"
#include "support/SimulatedScans.h"

namespace {

std::atomic<std::size_t> allocations{0};

[[maybe_unused]] void* counted(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

#ifndef __SANITIZE_THREAD__  // whose library has these operators
// These operators replace those of this test program and of the library it loads.
void* operator new(std::size_t size) {
  return counted(size);
}
void* operator new[](std::size_t size) {
  return counted(size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
#endif

namespace polemcl::test_pole_extractor_resources {

using namespace polemcl::clouds;

namespace {

PoleExtractor extractorFor(const std::string& model, double height) {
  SensorOptions sensor = sensorOptions(model);
  sensor.height = height;
  return PoleExtractor(sensor, {});
}

/// Lets Highway choose by itself again, whatever becomes of a test.
struct AnyInstructionSet {
  ~AnyInstructionSet() { hwy::SetSupportedTargetsForTest(0); }
};

}  // namespace

TEST(PoleExtractorResources, EveryInstructionSetGivesTheSameBytes) {
  const AnyInstructionSet restore;
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  ASSERT_GE(targets.size(), 2u) << "nothing to compare on this processor";
  for (const std::string model : {"hdl32e", "vlp16"})
    for (const LabelledScan& s : streetScans(21, model, 1.3, 2)) {
      hwy::SetSupportedTargetsForTest(0);
      PoleExtractor extract = extractorFor(model, 1.3);
      const auto expected = extract.extract(s.scan.view());
      ASSERT_GT(expected.size(), 3u);
      const ExtractionReport report = extract.report();
      for (const std::int64_t target : targets) {
        hwy::SetSupportedTargetsForTest(target);
        ASSERT_EQ(hwy::SupportedTargets(), target);
        EXPECT_TRUE(same(extract.extract(s.scan.view()), expected)) << hwy::TargetName(target);
        EXPECT_EQ(extract.report().candidates, report.candidates) << hwy::TargetName(target);
        EXPECT_EQ(extract.report().outOfRange, report.outOfRange) << hwy::TargetName(target);
      }
    }
}

TEST(PoleExtractorResources, TakesNothingFromTheHeapOnceWarm) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the thread sanitizer has a new of its own";
#endif
  for (const std::string model : {"hdl32e", "vlp16"}) {
    const auto scans = streetScans(22, model, 1.3, 4);
    PoleExtractor extract = extractorFor(model, 1.3);
    std::size_t before = allocations;
    for (const LabelledScan& s : scans) extract.extract(s.scan.view());
    EXPECT_GT(allocations, before) << "the counter counts";
    before = allocations;
    std::size_t poles = 0;
    for (int round = 0; round < 3; ++round)
      for (const LabelledScan& s : scans) poles += extract.extract(s.scan.view()).size();
    EXPECT_EQ(allocations, before) << model;
    EXPECT_GT(poles, 10u);
  }
}

}  // namespace polemcl::test_pole_extractor_resources
