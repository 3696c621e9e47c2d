#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <ostream>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/extraction/ExtractionOptions.h>

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
    BAD("paperRadii", "[range_image]", "max_radius_m",
        o.rangeImage.maxRadius = o.rangeImage.minRadius),
    BAD("paperRadiusNegative", "[range_image]", "min_radius_m", o.rangeImage.minRadius = -0.1),
    BAD("paperFitPoints", "[range_image]", "min_fit_points = 2", o.rangeImage.minFitPoints = 2),
    BAD("paperRing", "[range_image]", "free_ring_m", o.rangeImage.freeRing = -0.1),
    BAD("paperShare", "[range_image]", "free_share", o.rangeImage.freeShare = -0.1),
    BAD("paperFit", "[range_image]", "circle_fit = pratt", o.rangeImage.circleFit = "pratt"),
    BAD("paperSpace", "[range_image]", "free_space = box", o.rangeImage.freeSpace = "box"),
    BAD("paperOrigin", "[range_image]", "project_from = robot", o.rangeImage.projectFrom = "robot"),
    BAD("paperForegroundTest", "[range_image]", "foreground_test = all",
        o.rangeImage.foregroundTest = "all"),
    BAD("paperStep", "[range_image]", "coordinate_step_m = 2", o.rangeImage.coordinateStep = 2),
    BAD("paperStepNan", "[range_image]", "coordinate_step_m", o.rangeImage.coordinateStep = kNan),
    BAD("nativeWidth", "[scan_line]", "max_width_m = 0", o.scanLine.maxWidth = 0),
    BAD("nativeConnect", "[scan_line]", "connect_step_m = 0", o.scanLine.connectStep = 0),
    BAD("nativeEdge", "[scan_line]", "edge_step_m",
        o.scanLine.edgeStep = 0.5 * o.scanLine.connectStep),
    BAD("nativeReach", "[scan_line]", "stack_reach_m = 0", o.scanLine.stackReach = 0),
    BAD("nativeGap", "[scan_line]", "stack_gap_m", o.scanLine.stackGap = -1),
    BAD("nativeHeight", "[scan_line]", "min_height_m", o.scanLine.minHeight = -1),
    BAD("nativeRadii", "[scan_line]", "max_radius_m", o.scanLine.maxRadius = o.scanLine.minRadius),
    BAD("nativeRadiusNegative", "[scan_line]", "min_radius_m", o.scanLine.minRadius = -0.1),
    BAD("nativeTiltNone", "[scan_line]", "max_tilt_deg", o.scanLine.maxTilt = 0),
    BAD("nativeTiltLying", "[scan_line]", "max_tilt_deg", o.scanLine.maxTilt = 1.5),
    BAD("nativeSpacing", "[scan_line]", "min_spacing_m", o.scanLine.minSpacing = -0.1),
    BAD("nativeScatter", "[scan_line]", "max_scatter_m", o.scanLine.maxScatter = 0),
    BAD("nativePoints", "[scan_line]", "min_points = 1", o.scanLine.minPoints = 1),
    BAD("nativeConfidenceLow", "[scan_line]", "min_confidence", o.scanLine.minConfidence = -0.1),
    BAD("nativeConfidenceHigh", "[scan_line]", "min_confidence", o.scanLine.minConfidence = 1.1),
    BAD("nativeRange", "[scan_line]", "max_range_m = 0", o.scanLine.maxRange = 0),
    BAD("nativeTopNan", "[scan_line]", "min_top_m", o.scanLine.minTop = kNan),
    BAD("nativeBottomNan", "[scan_line]", "max_bottom_m", o.scanLine.maxBottom = kNan),
    BAD("nativeRangeEndless", "[scan_line]", "max_range_m", o.scanLine.maxRange = 1e9),
    BAD("paperRangeEndless", "[range_image]", "max_range_m", o.rangeImage.maxRange = 1e9),
    BAD("nativeReachTiny", "[scan_line]", "stack_reach_m", o.scanLine.stackReach = 1e-6),
    BAD("paperAspect", "[range_image]", "min_aspect", o.rangeImage.minAspect = kNan),
    BAD("paperTop", "[range_image]", "min_top_m", o.rangeImage.minTop = kNan),
    BAD("paperBottom", "[range_image]", "max_bottom_m", o.rangeImage.maxBottom = kNan),
    BAD("paperHeight", "[range_image]", "min_height_m", o.rangeImage.minHeight = kNan),
    BAD("paperMargin", "[range_image]", "fit_margin_m", o.rangeImage.fitMargin = -0.1),
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
