#pragma once
/// \file LocalizerNode.h
/// \brief polemcl::Localizer as a lifecycle node: clouds and odometry in, pose and transform out.

#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

#include <deque>
#include <diagnostic_msgs/msg/diagnostic_array.hpp>
#include <geometry_msgs/msg/pose_with_covariance_stamped.hpp>
#include <memory>
#include <nav_msgs/msg/odometry.hpp>
#include <optional>
#include <rclcpp_lifecycle/lifecycle_node.hpp>
#include <rclcpp_lifecycle/lifecycle_publisher.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>
#include <std_srvs/srv/trigger.hpp>
#include <string>
#include <vector>
#include <visualization_msgs/msg/marker_array.hpp>

#include <polemcl/polemcl.h>

namespace polemcl_ros {

/// \brief The node. share/doc/ros.md lists topics, parameters and frames.
///
/// All callbacks are of one group: none runs beside another.
class LocalizerNode : public rclcpp_lifecycle::LifecycleNode {
 public:
  explicit LocalizerNode(const rclcpp::NodeOptions& options);

  CallbackReturn on_configure(const rclcpp_lifecycle::State&) override;
  CallbackReturn on_activate(const rclcpp_lifecycle::State& state) override;
  CallbackReturn on_deactivate(const rclcpp_lifecycle::State& state) override;
  CallbackReturn on_cleanup(const rclcpp_lifecycle::State&) override;
  CallbackReturn on_shutdown(const rclcpp_lifecycle::State&) override;

 private:
  using Cloud = sensor_msgs::msg::PointCloud2;
  using Odometry = nav_msgs::msg::Odometry;
  using StartPose = geometry_msgs::msg::PoseWithCovarianceStamped;
  using Trigger = std_srvs::srv::Trigger;

  void setUp();
  void release();
  void advertise();
  void subscribe();
  void unsubscribe();
  /// \brief The parameters that are keys of the INI file, as `section.key=value`.
  std::vector<std::string> assignments() const;

  void take(const Cloud::ConstSharedPtr& cloud);
  void take(const Odometry& odometry);
  void take(const StartPose& start);
  void searchEverywhere(const Trigger::Request& request, Trigger::Response& response);

  /// \brief Takes the frames of the odometry and the robot. \throws Error when they change, or are
  /// none for a transform from the map to the odometry.
  void takeFrames(const Odometry& odometry);
  /// \brief Logs it now and then, and says it on /diagnostics.
  void refuse(const std_msgs::msg::Header& scan, const std::string& why);
  /// \brief Localizes the scans whose odometry and sensor pose are there.
  void localizeWaiting();
  /// \brief Pose of the LiDAR on the robot at the time of a scan, m. Sets `m_lack`.
  /// \return Nothing while odometry or transform of that time are missing.
  /// \throws Error when the clouds are in the frame of the odometry or of the map.
  std::optional<Eigen::Isometry3d> poseOnRobot(const std_msgs::msg::Header& lidar);
  void localize(const Cloud& cloud, const Eigen::Isometry3d& T_robot_lidar);
  /// \brief Learns how the LiDAR turns; a timing that a later scan refutes goes out of use.
  void learnTiming(const polemcl::io::TimedCloud& scan);
  void publish(const polemcl::LocalizationUpdate& update, const std_msgs::msg::Header& lidar);

  std::optional<polemcl::Localizer> m_localizer;
  std::string m_mapFrame, m_odometryFrame, m_robotFrame;
  double m_tolerance = 0;  ///< for which the transform is valid after its scan, s
  std::deque<Cloud::ConstSharedPtr> m_waiting;  ///< for odometry of their time
  std::string m_lack;                           ///< what the first of them waits for
  bool m_learnsTiming = false;           ///< how the LiDAR turns: neither stated nor given up
  polemcl::io::TimingEstimate m_timing;  ///< what the scans so far tell
  std::string m_timingNote;              ///< as logged
  std::size_t m_scans = 0;               ///< so far

  rclcpp::Clock m_steadyClock{
      RCL_STEADY_TIME};  ///< for warnings now and then: simulated time jumps
  std::unique_ptr<tf2_ros::Buffer> m_transforms;
  std::unique_ptr<tf2_ros::TransformListener> m_listener;
  std::unique_ptr<tf2_ros::TransformBroadcaster> m_broadcaster;
  rclcpp::Subscription<Cloud>::SharedPtr m_clouds;
  rclcpp::Subscription<Odometry>::SharedPtr m_odometry;
  rclcpp::Subscription<StartPose>::SharedPtr m_starts;
  rclcpp::Service<Trigger>::SharedPtr m_search;
  template <class Message>
  using Publisher = std::shared_ptr<rclcpp_lifecycle::LifecyclePublisher<Message>>;
  Publisher<StartPose> m_pose;
  Publisher<diagnostic_msgs::msg::DiagnosticArray> m_diagnostics;
  Publisher<visualization_msgs::msg::MarkerArray> m_poles, m_mapPoles;
};

}  // namespace polemcl_ros
