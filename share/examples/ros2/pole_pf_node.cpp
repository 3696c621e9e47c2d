// UNTESTED: ROS 2 cannot be installed where this project is tested. See README.md.
// MRPT's ROS 2 particle filter (class PFLocalizationCore of mrpt_pf_localization) on a CPoleMap.
// The node of that package gives its filter laser scans and point clouds only, so this one extracts
// the poles first.
#include <mrpt/config/CConfigFile.h>
#include <mrpt/containers/yaml.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/ros2bridge/point_cloud2.h>
#include <mrpt/ros2bridge/pose.h>
#include <mrpt/ros2bridge/time.h>
#include <mrpt_pf_localization/mrpt_pf_localization_core.h>

#include <geometry_msgs/msg/pose_with_covariance_stamped.hpp>
#include <memory>
#include <nav_msgs/msg/odometry.hpp>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>

#include <polemcl/polemcl.h>

class PolePfNode : public rclcpp::Node {
 public:
  PolePfNode() : Node("pole_pf") {
    const auto yaml = mrpt::containers::yaml::FromFile(declare_parameter<std::string>("pf_params"));
    m_filter.init_from_yaml(yaml["/**"]["ros__parameters"], {});
    m_filter.set_map_from_metric_map(loadMap(declare_parameter<std::string>("map_ini")));

    polemcl::ObservationPoleExtractorOptions options;
    options.sensor.model = declare_parameter<std::string>("lidar", "vlp16");
    options.sensor.height = declare_parameter<double>("lidar_height", 1.0);  // m above ground
    m_extractor = std::make_unique<polemcl::ObservationPoleExtractor>(options);

    m_pose = create_publisher<geometry_msgs::msg::PoseWithCovarianceStamped>("pose", 10);
    m_points = create_subscription<sensor_msgs::msg::PointCloud2>(
        "points", rclcpp::SensorDataQoS(),
        [this](const sensor_msgs::msg::PointCloud2& message) { onPoints(message); });
    m_odometry = create_subscription<nav_msgs::msg::Odometry>(
        "odom", 50, [this](const nav_msgs::msg::Odometry& message) { onOdometry(message); });
  }

 private:
  static mrpt::maps::CMultiMetricMap::Ptr loadMap(const std::string& file) {
    mrpt::maps::TSetOfMetricMapInitializers list;
    list.loadFromConfigFile(mrpt::config::CConfigFile(file), "MetricMap");
    auto maps = mrpt::maps::CMultiMetricMap::Create();
    maps->setListOfMaps(list);
    if (!maps->mapByClass<polemcl::CPoleMap>())
      throw polemcl::Error(file + ": no pole map; set poleMap_count = 1 in [MetricMap]");
    return maps;
  }

  void onOdometry(const nav_msgs::msg::Odometry& message) {
    auto odometry = mrpt::obs::CObservationOdometry::Create();
    odometry->timestamp = mrpt::ros2bridge::fromROS(message.header.stamp);
    odometry->sensorLabel = "odom";
    odometry->odometry = mrpt::poses::CPose2D(mrpt::ros2bridge::fromROS(message.pose.pose));
    m_filter.on_observation(odometry);
  }

  /// The cloud is in the frame of the LiDAR, which is taken as that of the robot.
  void onPoints(const sensor_msgs::msg::PointCloud2& message) {
    auto points = mrpt::maps::CPointsMapXYZI::Create();
    if (!mrpt::ros2bridge::fromROS(message, *points)) return;
    mrpt::obs::CObservationPointCloud cloud;
    cloud.timestamp = mrpt::ros2bridge::fromROS(message.header.stamp);
    cloud.sensorLabel = "lidar";
    cloud.pointcloud = points;
    m_filter.on_observation(m_extractor->process(cloud));
    m_filter.step();
    publish(message.header.stamp);
  }

  void publish(const builtin_interfaces::msg::Time& stamp) {
    const auto particles = m_filter.getLastPoseEstimation();
    if (!particles) return;
    mrpt::poses::CPose3DPDFGaussian pose;
    pose.copyFrom(*particles);
    geometry_msgs::msg::PoseWithCovarianceStamped message;
    message.header.stamp = stamp;
    message.header.frame_id = "map";
    message.pose = mrpt::ros2bridge::toROS_Pose(pose);
    m_pose->publish(message);
  }

  PFLocalizationCore m_filter;
  std::unique_ptr<polemcl::ObservationPoleExtractor> m_extractor;
  rclcpp::Publisher<geometry_msgs::msg::PoseWithCovarianceStamped>::SharedPtr m_pose;
  rclcpp::Subscription<sensor_msgs::msg::PointCloud2>::SharedPtr m_points;
  rclcpp::Subscription<nav_msgs::msg::Odometry>::SharedPtr m_odometry;
};

int main(int count, char** arguments) {
  rclcpp::init(count, arguments);
  rclcpp::spin(std::make_shared<PolePfNode>());
  rclcpp::shutdown();
}
