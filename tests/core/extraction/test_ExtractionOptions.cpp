#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <ostream>

#include "core/common/Types.h"
#include "core/extraction/ExtractionOptions.h"

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
    options.validate();
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
    BAD("paperNoRows", "[paper]", "rows = 1", o.paper.rows = 1),
    BAD("paperManyRows", "[paper]", "rows = 1025", o.paper.rows = 1025),
    BAD("paperFewColumns", "[paper]", "columns = 15", o.paper.columns = 15),
    BAD("paperManyColumns", "[paper]", "columns = 65537", o.paper.columns = 65537),
    BAD("paperView", "[paper]", "fov_up_deg", o.paper.fovUp = o.paper.fovDown),
    BAD("paperViewNan", "[paper]", "fov_up_deg", o.paper.fovDown = kNan),
    BAD("paperHeights", "[paper]", "max_z_m", o.paper.maxZ = o.paper.minZ),
    BAD("paperRange", "[paper]", "max_range_m = 0", o.paper.maxRange = 0),
    BAD("paperEpsilon", "[paper]", "epsilon_m = 0", o.paper.epsilon = 0),
    BAD("paperEpsilonNan", "[paper]", "epsilon_m", o.paper.epsilon = kNan),
    BAD("paperPixels", "[paper]", "min_pixels = -1", o.paper.minPixels = -1),
    BAD("paperWidth", "[paper]", "max_width_px = 0", o.paper.maxWidthPx = 0),
    BAD("paperForegroundLow", "[paper]", "foreground", o.paper.foreground = -0.01),
    BAD("paperForegroundHigh", "[paper]", "foreground", o.paper.foreground = 1.01),
    BAD("paperRadii", "[paper]", "max_radius_m", o.paper.maxRadius = o.paper.minRadius),
    BAD("paperRadiusNegative", "[paper]", "max_radius_m", o.paper.minRadius = -0.1),
    BAD("paperFitPoints", "[paper]", "min_fit_points = 2", o.paper.minFitPoints = 2),
    BAD("paperRing", "[paper]", "free_ring_m", o.paper.freeRing = -0.1),
    BAD("paperShare", "[paper]", "free_share", o.paper.freeShare = -0.1),
    BAD("paperFit", "[paper]", "circle_fit = pratt", o.paper.circleFit = "pratt"),
    BAD("paperSpace", "[paper]", "free_space = box", o.paper.freeSpace = "box"),
    BAD("paperOrigin", "[paper]", "project_from = robot", o.paper.projectFrom = "robot"),
    BAD("paperForegroundTest", "[paper]", "foreground_test = all", o.paper.foregroundTest = "all"),
    BAD("paperStep", "[paper]", "coordinate_step_m = 2", o.paper.coordinateStep = 2),
    BAD("paperStepNan", "[paper]", "coordinate_step_m", o.paper.coordinateStep = kNan),
    BAD("nativeWidth", "[native]", "max_width_m = 0", o.native.maxWidth = 0),
    BAD("nativeConnect", "[native]", "connect_step_m = 0", o.native.connectStep = 0),
    BAD("nativeEdge", "[native]", "edge_step_m", o.native.edgeStep = 0.5 * o.native.connectStep),
    BAD("nativeReach", "[native]", "stack_reach_m = 0", o.native.stackReach = 0),
    BAD("nativeGap", "[native]", "stack_gap_m", o.native.stackGap = -1),
    BAD("nativeHeight", "[native]", "min_height_m", o.native.minHeight = -1),
    BAD("nativeRadii", "[native]", "max_radius_m", o.native.maxRadius = o.native.minRadius),
    BAD("nativeRadiusNegative", "[native]", "max_radius_m", o.native.minRadius = -0.1),
    BAD("nativeTiltNone", "[native]", "max_tilt_deg", o.native.maxTilt = 0),
    BAD("nativeTiltLying", "[native]", "max_tilt_deg", o.native.maxTilt = 1.5),
    BAD("nativeSpacing", "[native]", "min_spacing_m", o.native.minSpacing = -0.1),
    BAD("nativeScatter", "[native]", "max_scatter_m", o.native.maxScatter = 0),
    BAD("nativePoints", "[native]", "min_points = 1", o.native.minPoints = 1),
    BAD("nativeConfidenceLow", "[native]", "min_confidence", o.native.minConfidence = -0.1),
    BAD("nativeConfidenceHigh", "[native]", "min_confidence", o.native.minConfidence = 1.1),
    BAD("nativeRange", "[native]", "max_range_m = 0", o.native.maxRange = 0),
    BAD("nativeTopNan", "[native]", "min_top_m", o.native.minTop = kNan),
    BAD("nativeBottomNan", "[native]", "max_bottom_m", o.native.maxBottom = kNan),
    BAD("nativeRangeEndless", "[native]", "max_range_m", o.native.maxRange = 1e9),
    BAD("paperRangeEndless", "[paper]", "max_range_m", o.paper.maxRange = 1e9),
    BAD("nativeReachTiny", "[native]", "stack_reach_m", o.native.stackReach = 1e-6),
    BAD("paperAspect", "[paper]", "min_aspect", o.paper.minAspect = kNan),
    BAD("paperTop", "[paper]", "min_top_m", o.paper.minTop = kNan),
    BAD("paperBottom", "[paper]", "max_bottom_m", o.paper.maxBottom = kNan),
    BAD("paperHeight", "[paper]", "min_height_m", o.paper.minHeight = kNan),
    BAD("paperMargin", "[paper]", "fit_margin_m", o.paper.fitMargin = -0.1),
    BAD("paperFitHeight", "[paper]", "fit_max_z_m", o.paper.fitMaxZ = kNan)};

}  // namespace

TEST(ExtractionOptions, defaultsAreAccepted) {
  EXPECT_EQ(refusal({}), "accepted");
}

TEST_P(ExtractionOptionsRefusal, namesSectionKeyAndWhatIsAllowed) {
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
