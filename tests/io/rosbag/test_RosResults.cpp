#include "io/rosbag/Cdr.h"
#include "io/rosbag/RosMessages.h"
#include "io/rosbag/RosResults.h"
#include "support/IoFiles.h"
#include "support/RosBags.h"

namespace polemcl::test_ros_results {

using namespace polemcl::io;
using namespace polemcl::tests;

TEST(RosResults, TransformsAreThoseThatOurReaderReads) {
  const std::string message = encodeTransform({12.25, "map"}, "base_link", {3, -4, 0.5});
  const auto links = decodeTransforms(message, "");
  ASSERT_EQ(links.size(), 1u);
  EXPECT_EQ(links[0].header.time, 12.25);
  EXPECT_EQ(links[0].header.frame, "map");
  EXPECT_EQ(links[0].child, "base_link");
  const auto& T = *links[0].T_parent_child;
  EXPECT_NEAR((T.translation() - Eigen::Vector3d(3, -4, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR(std::atan2(T(1, 0), T(0, 0)), 0.5, 1e-12);
}

TEST(RosResults, PosesHaveTheBytesOfTheFormat) {
  PoseWithCovariance pose{{1, 2, 0.25}, Eigen::Matrix3d::Zero()};
  pose.covariance << 1, 2, 3, 2, 4, 5, 3, 5, 6;
  CdrWriter expected;
  expected.header(1700000000.5, "map").pose(1, 2, 0, 0.25);
  for (const double value : {1., 2., 0., 0., 0., 3., 2., 4., 0., 0., 0., 5.}) expected.put(value);
  expected.zeros(18);
  for (const double value : {3., 5., 0., 0., 0., 6.}) expected.put(value);
  EXPECT_EQ(encodePose({1700000000.5, "map"}, pose), expected.message());
}

TEST(RosResults, PathsHoldEachPoseWithItsTime) {
  CdrWriter expected;
  expected.header(2, "map").put(std::uint32_t{2});
  expected.header(1, "map").pose(1, 2, 0, 0);
  expected.header(2, "map").pose(3, 4, 0, 1);
  EXPECT_EQ(encodePath({2, "map"}, {{1, {1, 2, 0}}, {2, {3, 4, 1}}}), expected.message());
}

TEST(RosResults, DiagnosticsHoldLevelAndValues) {
  CdrWriter expected;
  expected.header(3, "").put(std::uint32_t{1}).put(std::uint8_t{1});
  expected.text("n").text("m").text("").put(std::uint32_t{1}).text("k").text("v");
  EXPECT_EQ(encodeDiagnostic({3, ""}, {RosDiagnostic::warning, "n", "m", {{"k", "v"}}}),
            expected.message());
}

TEST(RosResults, MarkersReplaceThoseBefore) {
  const std::string message = encodePoles({1, "map"}, "p", {{5, 6, 0.2, 1, 4, 1, 0.5, 0}});
  CdrReader reader(message, "");
  ASSERT_EQ(reader.getCount(1), 2u);
  for (const std::int32_t action : {3, 0}) {
    EXPECT_EQ(readHeader(reader).frame, "map");
    EXPECT_EQ(reader.getText(), "p");
    for (const std::int32_t expected : {0, 3, action})
      EXPECT_EQ(reader.get<std::int32_t>(), expected);
    std::vector<double> numbers;
    for (int i = 0; i < 10; ++i) numbers.push_back(reader.get<double>());
    const std::vector<double> cylinder{5, 6, 2.5, 0, 0, 0, 1, 0.4, 0.4, 3};
    if (action == 0) {
      EXPECT_EQ(numbers, cylinder);
    }
    for (int i = 0; i < 4; ++i) reader.get<float>();
    reader.get<std::int32_t>();
    reader.get<std::uint32_t>();
    EXPECT_EQ(reader.get<std::uint8_t>(), 0);
    EXPECT_EQ(reader.getCount(1) + reader.getCount(1), 0u) << "points and colours";
    EXPECT_EQ(reader.getText(), "");
    EXPECT_EQ(readHeader(reader).frame, "") << "of the texture";
    EXPECT_EQ(reader.getText(), "");
    EXPECT_EQ(reader.getCount(1) + reader.getCount(1), 0u);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(reader.getText(), "");
    EXPECT_EQ(reader.getCount(1), 0u);
    EXPECT_EQ(reader.get<std::uint8_t>(), 0);
  }
  EXPECT_ANY_THROW(reader.get<std::uint8_t>()) << "nothing is left";
}

TEST(RosResults, RefusesTimesThatRosCannotState) {
  EXPECT_EQ(rosNanoseconds(2.75), 2750000000u);
  for (const double time : {-1.0, 2147483648.0, std::nan("")})
    EXPECT_REFUSED(rosNanoseconds(time), "bags of ROS 2 state times from 0 to 2147483647 s");
}

}  // namespace polemcl::test_ros_results
