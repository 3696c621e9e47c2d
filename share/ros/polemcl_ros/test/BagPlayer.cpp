// Plays a bag (SQLite, uncompressed) to the node /polemcl, one scan after another, and writes its
// poses: bag_player BAG.db3 OUT.tum [SEARCH_AT [START_AT]]. Configures and activates the node and
// waits after each scan for what it says. Before the scan SEARCH_AT it calls the global search,
// before START_AT it sends the last pose as /initialpose. Ends with an error when an answer does
// not come, or the outputs contradict each other.
#include <sqlite3.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <diagnostic_msgs/msg/diagnostic_array.hpp>
#include <functional>
#include <geometry_msgs/msg/pose_with_covariance_stamped.hpp>
#include <lifecycle_msgs/srv/change_state.hpp>
#include <map>
#include <nav_msgs/msg/odometry.hpp>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp/serialization.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>
#include <std_srvs/srv/trigger.hpp>
#include <stdexcept>
#include <string>
#include <tf2_msgs/msg/tf_message.hpp>
#include <thread>
#include <vector>
#include <visualization_msgs/msg/marker_array.hpp>

namespace {

using namespace std::chrono_literals;
using Pose = geometry_msgs::msg::PoseWithCovarianceStamped;

struct Recorded {
  std::string topic, type;
  std::int64_t time = 0;  ///< ns
  rclcpp::SerializedMessage bytes;
};

std::vector<Recorded> readBag(const char* file) {
  sqlite3* bag = nullptr;
  sqlite3_stmt* rows = nullptr;
  if (sqlite3_open_v2(file, &bag, SQLITE_OPEN_READONLY, nullptr) != SQLITE_OK ||
      sqlite3_prepare_v2(bag,
                         "SELECT name, type, timestamp, data FROM messages JOIN topics ON "
                         "topic_id = topics.id ORDER BY timestamp, messages.id",
                         -1, &rows, nullptr) != SQLITE_OK)
    throw std::runtime_error(std::string(file) + ": " + sqlite3_errmsg(bag));
  std::vector<Recorded> messages;
  while (sqlite3_step(rows) == SQLITE_ROW) {
    const auto text = [&](int column) {
      return std::string(reinterpret_cast<const char*>(sqlite3_column_text(rows, column)));
    };
    Recorded message;
    message.topic = text(0);
    message.type = text(1);
    message.time = sqlite3_column_int64(rows, 2);
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(rows, 3));
    message.bytes.reserve(size);
    auto& raw = message.bytes.get_rcl_serialized_message();
    std::memcpy(raw.buffer, sqlite3_column_blob(rows, 3), size);
    raw.buffer_length = size;
    messages.push_back(std::move(message));
  }
  sqlite3_finalize(rows);
  sqlite3_close(bag);
  return messages;
}

std::int64_t nanoseconds(const builtin_interfaces::msg::Time& stamp) {
  return stamp.sec * std::int64_t{1000000000} + stamp.nanosec;
}

double yawOf(const geometry_msgs::msg::Quaternion& q) {
  return 2 * std::atan2(q.z, q.w);
}

class Player : public rclcpp::Node {
 public:
  Player() : Node("bag_player") {
    m_subscriptions.push_back(create_subscription<Pose>(
        "/polemcl/pose", rclcpp::QoS(10).reliable(),
        [this](const Pose& pose) { m_poses[nanoseconds(pose.header.stamp)] = pose; }));
    m_subscriptions.push_back(create_subscription<tf2_msgs::msg::TFMessage>(
        "/tf", 100, [this](const tf2_msgs::msg::TFMessage& message) {
          for (const auto& transform : message.transforms) m_transform = transform;
        }));
    m_subscriptions.push_back(create_subscription<diagnostic_msgs::msg::DiagnosticArray>(
        "/diagnostics", 10, [this](const diagnostic_msgs::msg::DiagnosticArray& message) {
          m_health = message.status.at(0).message;
          ++m_diagnostics;
          m_searching += m_health == "lost: searching" ? 1 : 0;
        }));
    const auto count = [](std::size_t& markers) {
      return [&markers](const visualization_msgs::msg::MarkerArray& message) {
        markers += message.markers.size() - 1;  // without the one that deletes
      };
    };
    m_subscriptions.push_back(create_subscription<visualization_msgs::msg::MarkerArray>(
        "/polemcl/poles", 10, count(m_seen)));
    m_subscriptions.push_back(create_subscription<visualization_msgs::msg::MarkerArray>(
        "/polemcl/map_poles", rclcpp::QoS(1).transient_local(), count(m_mapPoles)));
  }

  void change(std::uint8_t transition);
  void play(const std::vector<Recorded>& messages);
  void write(const char* file) const;
  void checkOutputs();

  std::size_t searchAt = SIZE_MAX, startAt = SIZE_MAX;  ///< numbers of scans, from 0

 private:
  void waitUntil(const std::string& what, const std::function<bool()>& isSo);
  template <class Service>
  typename Service::Response::SharedPtr call(const std::string& name,
                                             typename Service::Request::SharedPtr request);
  rclcpp::GenericPublisher& publisherOf(const Recorded& message);
  void publish(const Recorded& message);
  void act(std::size_t scan);
  bool isAnswered(std::size_t scans) const;

  std::map<std::int64_t, Pose> m_poses;  ///< by stamp, ns
  geometry_msgs::msg::TransformStamped m_transform;
  nav_msgs::msg::Odometry m_odometry;  ///< the last one
  rclcpp::Publisher<Pose>::SharedPtr m_start = create_publisher<Pose>("/initialpose", 1);
  std::string m_health;
  std::size_t m_diagnostics = 0, m_searching = 0, m_seen = 0, m_mapPoles = 0;
  std::map<std::string, rclcpp::GenericPublisher::SharedPtr> m_publishers;
  std::vector<rclcpp::SubscriptionBase::SharedPtr> m_subscriptions;
};

void Player::waitUntil(const std::string& what, const std::function<bool()>& isSo) {
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (!isSo()) {
    if (std::chrono::steady_clock::now() > end || !rclcpp::ok())
      throw std::runtime_error("waited 20 s for " + what);
    rclcpp::spin_some(shared_from_this());
    std::this_thread::sleep_for(200us);
  }
}

template <class Service>
typename Service::Response::SharedPtr Player::call(const std::string& name,
                                                   typename Service::Request::SharedPtr request) {
  const auto client = create_client<Service>(name);
  waitUntil("the service " + name, [&] { return client->service_is_ready(); });
  auto answer = client->async_send_request(request).future.share();
  waitUntil("an answer of " + name,
            [&] { return answer.wait_for(0s) == std::future_status::ready; });
  return answer.get();
}

void Player::change(std::uint8_t transition) {
  auto request = std::make_shared<lifecycle_msgs::srv::ChangeState::Request>();
  request->transition.id = transition;
  if (!call<lifecycle_msgs::srv::ChangeState>("/polemcl/change_state", request)->success)
    throw std::runtime_error("transition " + std::to_string(transition) + " was refused");
}

rclcpp::GenericPublisher& Player::publisherOf(const Recorded& message) {
  auto& publisher = m_publishers[message.topic];
  if (!publisher) {
    rclcpp::QoS qos = rclcpp::QoS(100).reliable();
    if (message.topic == "/tf_static") qos.transient_local();
    publisher = create_generic_publisher(message.topic, message.type, qos);
    waitUntil("a subscriber of " + message.topic,
              [&] { return publisher->get_subscription_count() > 0; });
  }
  return *publisher;
}

void Player::publish(const Recorded& message) {
  publisherOf(message).publish(message.bytes);
  if (message.topic == "/tf_static") std::this_thread::sleep_for(500ms);  // before the first scan
  if (message.topic == "/odom")
    rclcpp::Serialization<nav_msgs::msg::Odometry>().deserialize_message(&message.bytes,
                                                                         &m_odometry);
}

/// What is to be done before a scan.
void Player::act(std::size_t scan) {
  if (scan == searchAt &&
      !call<std_srvs::srv::Trigger>("/polemcl/global_search",
                                    std::make_shared<std_srvs::srv::Trigger::Request>())
           ->success)
    throw std::runtime_error("the global search was refused");
  if (scan != startAt) return;
  Pose start = m_poses.rbegin()->second;
  for (const int place : {0, 7, 35}) start.pose.covariance[place] = place == 35 ? 0.01 : 0.25;
  waitUntil("a subscriber of /initialpose", [&] { return m_start->get_subscription_count() > 0; });
  m_start->publish(start);
  std::this_thread::sleep_for(500ms);  // nothing answers
}

/// A scan has the stamp of its odometry. A scan without a pose has diagnostics only.
bool Player::isAnswered(std::size_t scans) const {
  return m_diagnostics == scans &&
         (m_health == "lost: searching" || m_poses.count(nanoseconds(m_odometry.header.stamp)) > 0);
}

void Player::play(const std::vector<Recorded>& messages) {
  for (const Recorded& message : messages) publisherOf(message);  // all are there before any plays
  std::size_t scans = 0;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    if (messages[i].topic == "/points") act(scans++);
    publish(messages[i]);
    if (i + 1 == messages.size() || messages[i + 1].time > messages[i].time)
      waitUntil("what the node says of scan " + std::to_string(scans - 1),
                [&] { return isAnswered(scans); });
  }
}

/// With the digits of pole-localize.
void Player::write(const char* file) const {
  std::FILE* out = std::fopen(file, "w");
  if (!out) throw std::runtime_error(std::string(file) + " cannot be written");
  for (const auto& [time, pose] : m_poses) {
    const auto& p = pose.pose.pose;
    std::fprintf(out, "%lld.%09lld %.9f %.9f 0.000000000 0.000000000 0.000000000 %.9f %.9f\n",
                 static_cast<long long>(time / 1000000000),
                 static_cast<long long>(time % 1000000000), p.position.x, p.position.y,
                 p.orientation.z, p.orientation.w);
  }
  std::fclose(out);
}

/// map -> odom with the odometry must give the pose; the other topics must have been sent.
void Player::checkOutputs() {
  const auto& [time, last] = *m_poses.rbegin();
  waitUntil("the last transform", [&, stamp = time] {
    return nanoseconds(m_transform.header.stamp) == stamp + 500000000;  // transform_tolerance_s
  });
  waitUntil("markers of the map", [&] { return m_mapPoles > 0; });
  const auto& pose = last.pose.pose;
  const auto& t = m_transform.transform.translation;
  const auto& at = m_odometry.pose.pose.position;
  const double yaw = yawOf(m_transform.transform.rotation);
  const double x = t.x + std::cos(yaw) * at.x - std::sin(yaw) * at.y,
               y = t.y + std::sin(yaw) * at.x + std::cos(yaw) * at.y;
  const double off = std::hypot(x - pose.position.x, y - pose.position.y);
  std::printf("%s -> %s with the odometry: %.1e m off the pose\n",
              m_transform.header.frame_id.c_str(), m_transform.child_frame_id.c_str(), off);
  std::printf("diagnostics: %zu, of them searching: %zu, the last: %s\n", m_diagnostics,
              m_searching, m_health.c_str());
  std::printf("markers: %zu of the map, %zu of scans\n", m_mapPoles, m_seen);
  if (off > 1e-9 || m_seen == 0) throw std::runtime_error("outputs contradict each other");
}

}  // namespace

int main(int count, char** arguments) try {
  rclcpp::init(count, arguments);
  if (count < 3) throw std::runtime_error("usage: bag_player BAG.db3 OUT.tum");
  const auto messages = readBag(arguments[1]);
  const auto player = std::make_shared<Player>();
  if (count > 3) player->searchAt = std::stoul(arguments[3]);
  if (count > 4) player->startAt = std::stoul(arguments[4]);
  player->change(1);  // configure
  player->change(3);  // activate
  player->play(messages);
  player->write(arguments[2]);
  player->checkOutputs();
  player->change(4);  // deactivate
  player->change(2);  // clean up
  rclcpp::shutdown();
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bag_player: %s\n", error.what());
  return 1;
}
