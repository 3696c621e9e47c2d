#include "LocalizerNode.h"

#include <tf2/exceptions.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <rclcpp_components/register_node_macro.hpp>
#include <sstream>
#include <utility>

#include "Messages.h"

namespace polemcl_ros {
namespace {

/// A scan waits for odometry and transform until one comes that is so much later, s, or until more
/// of them wait.
constexpr double kLongestWait = 2;
constexpr std::size_t kMostWaiting = 50;
/// After the first scans, each of this number tells whether the LiDAR turns as was learnt.
constexpr std::size_t kTimingEvery = 20;
constexpr int kWarningEvery = 5000;  // ms
/// The frame of a robot whose odometry does not name it, as of many drivers.
constexpr const char* kDefaultRobotFrame = "base_link";

/// Names without a dot: those of this node, and those that rclcpp declares.
constexpr std::array<const char*, 6> kParameters{"settings",     "map",
                                                 "map_frame",    "transform_tolerance_s",
                                                 "use_sim_time", "start_type_description_service"};

/// Parameters of the INI file have names that nobody can declare beforehand.
rclcpp::NodeOptions withAllParameters(rclcpp::NodeOptions options) {
  return options.automatically_declare_parameters_from_overrides(true);
}

/// The value as an INI file has it.
std::string textOf(const rclcpp::Parameter& parameter) {
  std::ostringstream text;
  text.precision(17);
  if (parameter.get_type() == rclcpp::ParameterType::PARAMETER_DOUBLE)
    text << parameter.as_double();
  else if (parameter.get_type() == rclcpp::ParameterType::PARAMETER_DOUBLE_ARRAY)
    for (const double value : parameter.as_double_array()) text << value << ' ';
  else if (parameter.get_type() == rclcpp::ParameterType::PARAMETER_INTEGER_ARRAY)
    for (const std::int64_t value : parameter.as_integer_array()) text << value << ' ';
  else
    text << parameter.value_to_string();
  return text.str();
}

/// Twice the standard deviation along the worst axis, m; none if the covariance says nothing.
std::optional<double> radiusOf(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance.topLeftCorner<2, 2>());
  const double variance = axes.eigenvalues().maxCoeff();
  return variance > 0 ? std::optional(2 * std::sqrt(variance)) : std::nullopt;
}

std::optional<double> headingOf(const Eigen::Matrix3d& covariance) {
  const double variance = covariance(2, 2);
  return variance > 0 ? std::optional(std::min(M_PI, 2 * std::sqrt(variance))) : std::nullopt;
}

/// s. \throws Error unless it is in [0, 10].
double toleranceOf(const rclcpp::Parameter& parameter) {
  const bool isWhole = parameter.get_type() == rclcpp::ParameterType::PARAMETER_INTEGER;
  const double seconds = isWhole ? static_cast<double>(parameter.as_int()) : parameter.as_double();
  if (!(seconds >= 0 && seconds <= 10))
    throw polemcl::Error(parameter.get_name() + " = " + std::to_string(seconds) +
                         ": 0 to 10 s are allowed");
  return seconds;
}

rclcpp::SubscriptionOptions adjustable() {
  rclcpp::SubscriptionOptions options;
  options.qos_overriding_options = rclcpp::QosOverridingOptions::with_default_policies();
  return options;
}

}  // namespace

LocalizerNode::LocalizerNode(const rclcpp::NodeOptions& options)
    : LifecycleNode("polemcl", withAllParameters(options)) {
  const auto declare = [&](const char* name, auto value) {
    if (!has_parameter(name)) declare_parameter(name, value);
  };
  declare("settings", std::string());
  declare("map", std::string());
  declare("map_frame", std::string("map"));
  declare("transform_tolerance_s", 0.5);
}

std::vector<std::string> LocalizerNode::assignments() const {
  std::vector<std::string> result;
  for (const std::string& name : list_parameters({}, 0).names) {
    if (name.rfind("qos_overrides", 0) == 0) continue;
    if (name.find('.') != std::string::npos)
      result.push_back(name + "=" + textOf(get_parameter(name)));
    else if (std::find(kParameters.begin(), kParameters.end(), name) == kParameters.end())
      RCLCPP_WARN(get_logger(), "the parameter %s is not known and not used", name.c_str());
  }
  return result;
}

LocalizerNode::CallbackReturn LocalizerNode::on_configure(const rclcpp_lifecycle::State&) {
  try {
    setUp();
  } catch (const std::exception& error) {
    RCLCPP_ERROR(get_logger(), "%s", error.what());
    release();
    return CallbackReturn::FAILURE;
  }
  return CallbackReturn::SUCCESS;
}

void LocalizerNode::setUp() {
  const std::string file = get_parameter("settings").as_string();
  const std::string map = get_parameter("map").as_string();
  if (file.empty() || map.empty())
    throw polemcl::Error(
        "the parameters settings and map must name an INI file and a map of poles (.polemap)");
  const polemcl::Settings settings(file, assignments());
  m_localizer.emplace(settings, map);
  m_learnsTiming = settings.sensor().timing.turn == polemcl::Turn::automatic;
  if (!m_localizer->isStarted()) m_localizer->startAnywhere();
  m_mapFrame = get_parameter("map_frame").as_string();
  m_tolerance = toleranceOf(get_parameter("transform_tolerance_s"));
  advertise();
  std_msgs::msg::Header header;  // without a stamp: valid at all times
  header.frame_id = m_mapFrame;
  polemcl::CPoleMap poles;
  poles.loadFromPoleMapFile(map);
  m_mapPoles->on_activate();  // kept for whoever comes later
  m_mapPoles->publish(markersOf(poles.poles(), header));
}

void LocalizerNode::advertise() {
  m_transforms = std::make_unique<tf2_ros::Buffer>(get_clock());
  m_listener = std::make_unique<tf2_ros::TransformListener>(*m_transforms, this, false);
  m_broadcaster = std::make_unique<tf2_ros::TransformBroadcaster>(*this);
  m_pose = create_publisher<StartPose>("~/pose", 10);
  m_diagnostics = create_publisher<diagnostic_msgs::msg::DiagnosticArray>("/diagnostics", 10);
  m_poles = create_publisher<visualization_msgs::msg::MarkerArray>("~/poles", 10);
  m_mapPoles = create_publisher<visualization_msgs::msg::MarkerArray>(
      "~/map_poles", rclcpp::QoS(1).transient_local());
}

void LocalizerNode::subscribe() {
  m_clouds = create_subscription<Cloud>(
      "points", rclcpp::SensorDataQoS(),
      [this](const Cloud::ConstSharedPtr& cloud) { take(cloud); }, adjustable());
  m_odometry = create_subscription<Odometry>(
      "odom", rclcpp::SensorDataQoS().keep_last(100),
      [this](const Odometry& odometry) { take(odometry); }, adjustable());
  m_starts = create_subscription<StartPose>("initialpose", 1,
                                            [this](const StartPose& start) { take(start); });
  m_search = create_service<Trigger>("~/global_search",
                                     [this](const std::shared_ptr<Trigger::Request> request,
                                            std::shared_ptr<Trigger::Response> response) {
                                       searchEverywhere(*request, *response);
                                     });
}

LocalizerNode::CallbackReturn LocalizerNode::on_activate(const rclcpp_lifecycle::State& state) {
  try {
    subscribe();
  } catch (const std::exception& error) {  // such as a word of qos_overrides that is none
    RCLCPP_ERROR(get_logger(), "%s", error.what());
    unsubscribe();
    return CallbackReturn::FAILURE;
  }
  return LifecycleNode::on_activate(state);  // and the publishers
}

LocalizerNode::CallbackReturn LocalizerNode::on_deactivate(const rclcpp_lifecycle::State& state) {
  unsubscribe();
  return LifecycleNode::on_deactivate(state);
}

LocalizerNode::CallbackReturn LocalizerNode::on_cleanup(const rclcpp_lifecycle::State&) {
  release();
  return CallbackReturn::SUCCESS;
}

LocalizerNode::CallbackReturn LocalizerNode::on_shutdown(const rclcpp_lifecycle::State&) {
  release();
  return CallbackReturn::SUCCESS;
}

void LocalizerNode::unsubscribe() {
  m_clouds.reset();
  m_odometry.reset();
  m_starts.reset();
  m_search.reset();
  m_waiting.clear();
}

void LocalizerNode::release() {
  unsubscribe();
  m_pose.reset();
  m_diagnostics.reset();
  m_poles.reset();
  m_mapPoles.reset();
  m_broadcaster.reset();
  m_listener.reset();
  m_transforms.reset();
  m_odometryFrame.clear();
  m_robotFrame.clear();
  m_timing = {};
  m_timingNote.clear();
  m_scans = 0;
  m_localizer.reset();
}

void LocalizerNode::take(const Cloud::ConstSharedPtr& cloud) {
  m_waiting.push_back(cloud);
  const double newest = secondsOf(cloud->header.stamp);
  const auto isOld = [&](const Cloud& scan) {  // or of a clock that was set back
    return std::abs(newest - secondsOf(scan.header.stamp)) > kLongestWait;
  };
  while (isOld(*m_waiting.front()) || m_waiting.size() > kMostWaiting) {
    refuse(m_waiting.front()->header, "a scan is dropped: " + m_lack);
    m_waiting.pop_front();
  }
  localizeWaiting();
}

void LocalizerNode::refuse(const std_msgs::msg::Header& scan, const std::string& why) {
  RCLCPP_ERROR_THROTTLE(get_logger(), m_steadyClock, kWarningEvery, "%s", why.c_str());
  m_diagnostics->publish(failureOf(why, scan));
}

void LocalizerNode::take(const Odometry& odometry) {
  try {
    const polemcl::OdometryReading reading = readingOf(odometry);
    takeFrames(odometry);
    m_localizer->addOdometry(reading);
  } catch (const std::exception& error) {
    RCLCPP_ERROR_THROTTLE(get_logger(), m_steadyClock, kWarningEvery, "%s: %s",
                          m_odometry->get_topic_name(), error.what());
  }
  localizeWaiting();
}

void LocalizerNode::takeFrames(const Odometry& odometry) {
  const std::string& parent = odometry.header.frame_id;
  const std::string& child = odometry.child_frame_id;
  const std::string robot = child.empty() ? kDefaultRobotFrame : child;
  if (parent.empty() || parent == m_mapFrame || parent == robot)
    throw polemcl::Error("its frame_id is \"" + parent +
                         "\"; a frame of its own is needed, other than the map (" + m_mapFrame +
                         ") and the robot (" + robot + ")");
  if (!m_robotFrame.empty() && (robot != m_robotFrame || parent != m_odometryFrame))
    throw polemcl::Error("it goes from " + parent + " to " + robot + ", before from " +
                         m_odometryFrame + " to " + m_robotFrame + "; one odometry is allowed");
  m_odometryFrame = parent;
  m_robotFrame = robot;
}

void LocalizerNode::take(const StartPose& start) {
  if (start.header.frame_id != m_mapFrame) {
    RCLCPP_ERROR(get_logger(), "initialpose is in the frame %s: %s is allowed",
                 start.header.frame_id.c_str(), m_mapFrame.c_str());
    return;
  }
  try {
    const polemcl::PoseWithCovariance guess = guessOf(start);
    m_localizer->start(guess.mean, radiusOf(guess.covariance), headingOf(guess.covariance));
  } catch (const std::exception& error) {
    RCLCPP_ERROR(get_logger(), "initialpose: %s", error.what());
  }
}

void LocalizerNode::searchEverywhere(const Trigger::Request&, Trigger::Response& response) {
  m_localizer->startAnywhere();
  response.success = true;
  response.message = "the poles of the next metres tell the pose";
}

void LocalizerNode::localizeWaiting() {
  while (!m_waiting.empty()) {
    const Cloud::ConstSharedPtr cloud = m_waiting.front();
    try {
      const auto T_robot_lidar = poseOnRobot(cloud->header);
      if (!T_robot_lidar) return;
      localize(*cloud, *T_robot_lidar);
    } catch (const std::exception& error) {
      refuse(cloud->header, error.what());
    }
    m_waiting.pop_front();
  }
}

std::optional<Eigen::Isometry3d> LocalizerNode::poseOnRobot(const std_msgs::msg::Header& lidar) {
  m_lack = "no odometry of its time came";
  if (!m_localizer->hasOdometry(secondsOf(lidar.stamp))) return std::nullopt;
  if (lidar.frame_id == m_robotFrame) return Eigen::Isometry3d::Identity();
  if (lidar.frame_id == m_odometryFrame || lidar.frame_id == m_mapFrame)
    throw polemcl::Error("these clouds are in " + lidar.frame_id +
                         ", the frame of the odometry or of the map, so they were moved; take the "
                         "topic of the LiDAR's driver");
  try {
    const tf2::TimePoint time = tf2_ros::fromMsg(lidar.stamp);
    return isometryOf(m_transforms->lookupTransform(m_robotFrame, lidar.frame_id, time).transform);
  } catch (const tf2::TransformException& error) {
    m_lack = error.what();
    return std::nullopt;
  }
}

void LocalizerNode::localize(const Cloud& cloud, const Eigen::Isometry3d& T_robot_lidar) {
  const std::string where = std::string(m_clouds->get_topic_name()) + ": ";
  const bool tellsTiming = m_learnsTiming && (!m_timing.complete() || m_scans % kTimingEvery == 0);
  const polemcl::io::TimedCloud scan = polemcl::io::unpack(packedOf(cloud), where, tellsTiming);
  const auto update =
      m_localizer->step(secondsOf(cloud.header.stamp), scan.cloud.view(), T_robot_lidar);
  publish(update, cloud.header);
  ++m_scans;
  if (tellsTiming) learnTiming(scan);
}

void LocalizerNode::learnTiming(const polemcl::io::TimedCloud& scan) {
  m_timing.add(scan);
  if (!m_timing.complete() || m_timing.note() == m_timingNote) return;
  m_timingNote = m_timing.note();
  const polemcl::ScanTiming timing = m_timing.timing();
  m_localizer->setRecordedTiming(timing);  // also where later scans refute what was learnt
  m_learnsTiming = timing.known();
  if (m_learnsTiming)
    RCLCPP_INFO(get_logger(), "%s", m_timingNote.c_str());
  else
    RCLCPP_WARN(get_logger(), "%s; [sensor] turn states it", m_timingNote.c_str());
}

void LocalizerNode::publish(const polemcl::LocalizationUpdate& update,
                            const std_msgs::msg::Header& lidar) {
  std_msgs::msg::Header header;
  header.stamp = lidar.stamp;
  header.frame_id = m_robotFrame;
  m_poles->publish(markersOf(m_localizer->poles(), header));
  header.frame_id = m_mapFrame;
  m_diagnostics->publish(
      diagnosticsOf(update, m_localizer->odometryJumps(), header, lidar.frame_id));
  if (!update.estimate) return;
  geometry_msgs::msg::TransformStamped transform;
  transform.header.stamp = rclcpp::Time(lidar.stamp) + rclcpp::Duration::from_seconds(m_tolerance);
  transform.header.frame_id = m_mapFrame;
  transform.child_frame_id = m_odometryFrame;
  transform.transform = transformOf(*m_localizer->odometryFrame());
  m_broadcaster->sendTransform(transform);
  m_pose->publish(poseMessage(header, *update.estimate));
}

}  // namespace polemcl_ros

RCLCPP_COMPONENTS_REGISTER_NODE(polemcl_ros::LocalizerNode)
