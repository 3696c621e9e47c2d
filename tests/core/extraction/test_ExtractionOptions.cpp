#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <ostream>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/extraction/ExtractionOptions.h>
#include "core/common/Binder.h"

namespace polemcl::test_extraction_options {

using namespace polemcl;

namespace {

/// A setting spoilt, and what the message must name.
struct Bad {
  std::string name;
  std::function<void(ExtractionOptions&)> spoil;
  std::string section, key;
};
void PrintTo(const Bad& bad, std::ostream* out) {
  *out << bad.name;
}

std::string refusal(const ExtractionOptions& options) {
  try {
    checkOptions(options);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

class ExtractionOptionsRefusal : public ::testing::TestWithParam<Bad> {};

const double kNan = std::nan("");

#define BAD(name, section, key, statement)                      \
  Bad {                                                         \
    name, [](ExtractionOptions& o) { statement; }, section, key \
  }

const std::vector<Bad> kBad = {
    BAD("paperNoRows", "[range_image]", "rows = 1", o.rangeImage.rows = 1),
    BAD("paperManyRows", "[range_image]", "rows = 1025", o.rangeImage.rows = 1025),
    BAD("paperFewColumns", "[range_image]", "columns = 15", o.rangeImage.columns = 15),
    BAD("paperManyColumns", "[range_image]", "columns = 65537", o.rangeImage.columns = 65537),
    BAD("paperView", "[range_image]", "fov_up_deg",
        o.rangeImage.fovUp = o.rangeImage.fovDown = -0.1),
    BAD("paperViewNan", "[range_image]", "fov_down_deg", o.rangeImage.fovDown = kNan),
    BAD("paperHeights", "[range_image]", "max_z_m", o.rangeImage.maxZ = o.rangeImage.minZ),
    BAD("paperRange", "[range_image]", "max_range_m = 0", o.rangeImage.maxRange = 0),
    BAD("paperEpsilon", "[range_image]", "epsilon_m = 0", o.rangeImage.epsilon = 0),
    BAD("paperEpsilonNan", "[range_image]", "epsilon_m", o.rangeImage.epsilon = kNan),
    BAD("paperPixels", "[range_image]", "min_pixels = -1", o.rangeImage.minPixels = -1),
    BAD("paperWidth", "[range_image]", "max_width_px = 0", o.rangeImage.maxWidthPx = 0),
    BAD("paperForegroundLow", "[range_image]", "foreground", o.rangeImage.foreground = -0.01),
    BAD("paperForegroundHigh", "[range_image]", "foreground", o.rangeImage.foreground = 1.01),
    BAD("paperRing", "[range_image]", "free_ring_m", o.rangeImage.freeRing = -0.1),
    BAD("paperOrigin", "[range_image]", "project_from = robot", o.rangeImage.projectFrom = "robot"),
    BAD("paperStep", "[range_image]", "coordinate_step_m = 2", o.rangeImage.coordinateStep = 2),
    BAD("paperStepNan", "[range_image]", "coordinate_step_m", o.rangeImage.coordinateStep = kNan),
    BAD("nativeHeight", "[scan_line]", "min_height_m", o.scanLine.minHeight = -1),
    BAD("nativeRadii", "[scan_line]", "max_radius_m", o.scanLine.maxRadius = o.scanLine.minRadius),
    BAD("nativeConfidenceLow", "[scan_line]", "min_confidence", o.scanLine.minConfidence = -0.1),
    BAD("nativeConfidenceHigh", "[scan_line]", "min_confidence", o.scanLine.minConfidence = 1.1),
    BAD("nativeRange", "[scan_line]", "max_range_m = 0", o.scanLine.maxRange = 0),
    BAD("nativeTopNan", "[scan_line]", "min_top_m", o.scanLine.minTop = kNan),
    BAD("nativeRangeEndless", "[scan_line]", "max_range_m", o.scanLine.maxRange = 1e9),
    BAD("paperRangeEndless", "[range_image]", "max_range_m", o.rangeImage.maxRange = 1e9),
    BAD("paperTop", "[range_image]", "min_top_m", o.rangeImage.minTop = kNan),
    BAD("paperBottom", "[range_image]", "max_bottom_m", o.rangeImage.maxBottom = kNan),
    BAD("paperHeight", "[range_image]", "min_height_m", o.rangeImage.minHeight = kNan),
    BAD("paperFitHeight", "[range_image]", "fit_max_z_m", o.rangeImage.fitMaxZ = kNan)};

}  // namespace

TEST(ExtractionOptions, DefaultsAreAccepted) {
  EXPECT_EQ(refusal({}), "accepted");
}

TEST_P(ExtractionOptionsRefusal, NamesSectionKeyAndWhatIsAllowed) {
  ExtractionOptions options;
  GetParam().spoil(options);
  const std::string message = refusal(options);
  EXPECT_EQ(message.find(GetParam().section), 0u) << message;
  EXPECT_NE(message.find(GetParam().key), std::string::npos) << message;
  EXPECT_NE(message.find("allowed"), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}
INSTANTIATE_TEST_SUITE_P(Each, ExtractionOptionsRefusal, ::testing::ValuesIn(kBad),
                         [](const auto& i) { return i.param.name; });

}  // namespace polemcl::test_extraction_options
