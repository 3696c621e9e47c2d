#include "io/dataset/Rosbag2.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "io/dataset/RosbagMotions.h"
#include "io/file/TextFile.h"
#include "io/rosbag/Bag.h"
#include "io/rosbag/RosMessages.h"

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

/// Enough bytes of a message for its header.
constexpr std::size_t kHeaderBytes = 1024;
constexpr const char* kDefaultRobotFrame = "base_link";

/// The topics with messages, of one type or all, and those left out, for messages.
std::string listTopics(const Bag& bag, const std::string& type = {}) {
  std::string list;
  for (const BagTopic& topic : bag.topics()) {
    if (topic.messages == 0 || (!type.empty() && topic.type != type)) continue;
    list += (list.empty() ? "" : ", ") + topic.name + " (" +
            (type.empty() ? topic.type + ", " : "") + std::to_string(topic.messages) + " messages)";
  }
  if (list.empty()) list = "none";
  for (const std::string& topic : bag.leftOut()) list += ", left out: " + topic;
  return list;
}

/// The topics of a type that have messages; with a name only that one.
std::vector<std::size_t> topicsOf(const Bag& bag, const std::string& type,
                                  const std::string& name = {}) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < bag.topics().size(); ++i) {
    const BagTopic& topic = bag.topics()[i];
    if (topic.type == type && topic.messages > 0 && (name.empty() || topic.name == name))
      found.push_back(i);
  }
  return found;
}

/// The topic of this name, or without a name the only one of its type that has messages.
/// \return Nothing if no topic has this type. \throws Error when the choice is not clear.
std::optional<std::size_t> chooseTopic(const Bag& bag, const std::string& type,
                                       const std::string& name, const std::string& option) {
  const std::vector<std::size_t> found = topicsOf(bag, type, name);
  if (!name.empty() && found.empty())
    throw Error(bag.path().string() + ": " + option + " " + name + ": no such topic of " + type +
                "; there are: " + listTopics(bag, type));
  if (found.size() > 1)
    throw Error(bag.path().string() + ": several topics of " + type + ": " + listTopics(bag, type) +
                "; choose one with " + option);
  return found.empty() ? std::nullopt : std::optional(found.front());
}

FrameTree readFrames(const Bag& bag, std::vector<std::string>& notes) {
  constexpr std::string_view kEnding = "tf_static";
  FrameTree frames;
  std::string invalid;
  for (std::size_t i = 0; i < bag.topics().size(); ++i) {
    const BagTopic& topic = bag.topics()[i];
    const bool isStatic =
        topic.name.size() >= kEnding.size() &&
        topic.name.compare(topic.name.size() - kEnding.size(), kEnding.size(), kEnding) == 0;
    if (topic.type != kTransformsType || !isStatic || topic.messages == 0) continue;
    for (const BagMessage& message : bag.messages(i))
      for (const auto& link : decodeTransforms(bag.read(message), bag.place(message))) {
        if (link.T_parent_child)
          frames.add(link.header.frame, link.child, *link.T_parent_child);
        else
          invalid += (invalid.empty() ? "" : ", ") + link.header.frame + " to " + link.child;
      }
  }
  if (!invalid.empty())
    notes.push_back("static transforms that are no rotation are left out: " + invalid);
  return frames;
}

/// The longest sequence of scans whose times increase: one wrong stamp costs one scan.
std::vector<ScanEntry> longestIncreasing(const std::vector<ScanEntry>& scans) {
  std::vector<std::size_t> ends;  // of the best sequence of each length
  std::vector<std::size_t> before(scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const auto isEarlier = [&](std::size_t end, double time) { return scans[end].time < time; };
    const auto place = std::lower_bound(ends.begin(), ends.end(), scans[i].time, isEarlier);
    if (place != ends.begin()) before[i] = *std::prev(place);
    if (place == ends.end())
      ends.push_back(i);
    else
      *place = i;
  }
  std::vector<ScanEntry> result(ends.size());
  std::size_t scan = ends.empty() ? 0 : ends.back();
  for (std::size_t i = result.size(); i-- > 0; scan = before[scan]) result[i] = scans[scan];
  return result;
}

/// The scans with their stamps. \param frame Set to the frame of the clouds.
ScanFolder listScans(const Bag& bag, std::size_t topic, std::string& frame) {
  ScanFolder folder;
  for (const BagMessage& message : bag.messages(topic)) {
    const std::string where = bag.place(message);
    const std::string bytes = bag.read(message, kHeaderBytes);
    CdrReader reader(bytes, where);
    const RosHeader header = readHeader(reader);
    if (folder.scans.empty()) frame = header.frame;
    if (header.frame != frame)
      throw Error(where + "frame " + header.frame + ", that of the clouds before is " + frame +
                  "; one LiDAR a topic is allowed");
    folder.scans.push_back(
        {bag.file(message), static_cast<std::uint64_t>(message.id), header.time});
  }
  const std::size_t all = folder.scans.size();
  folder.scans = longestIncreasing(folder.scans);
  const std::size_t unordered = all - folder.scans.size();
  if (2 * unordered > all)
    throw Error(bag.path().string() + ": " + bag.topics()[topic].name + ": the stamps of " +
                std::to_string(unordered) + " of " + std::to_string(all) +
                " clouds are not later than those before; record with stamps in the headers");
  if (unordered > 0)
    folder.notes.push_back(std::to_string(unordered) + " of " + std::to_string(all) +
                           " scans left out, stamped not later than those before");
  return folder;
}

RosCloud readScan(const Bag& bag, std::size_t topic, const ScanEntry& scan, bool withTimes) {
  const BagMessage message = bag.message(topic, scan.cloud, static_cast<std::int64_t>(scan.offset));
  return decodeCloud(bag.read(message), bag.place(message), withTimes);
}

/// From the first scans and some of the rest: the azimuth at which they begin may move slowly.
void estimateTiming(const Bag& bag, std::size_t topic, ScanFolder& folder) {
  constexpr std::size_t kRest = 20;
  TimingEstimate estimate;
  std::size_t i = 0;
  for (; i < folder.scans.size() && !estimate.complete(); ++i)
    estimate.add(readScan(bag, topic, folder.scans[i], true));
  const std::size_t step = 1 + (folder.scans.size() - i) / kRest;
  for (; i < folder.scans.size(); i += step)
    estimate.add(readScan(bag, topic, folder.scans[i], true));
  folder.timing = estimate.timing();
  folder.notes.push_back(estimate.note() + (folder.timing.known() ? "" : "; --turn states it"));
}

void findSensorPose(const FrameTree& frames, const std::string& robot, const std::string& sensor,
                    bool hasOdometry, ScanFolder& folder) {
  folder.T_robot_sensor = frames.find(robot, sensor);
  if (robot == sensor) return;
  if (folder.T_robot_sensor) {
    const Eigen::Vector3d at = folder.T_robot_sensor->translation();
    folder.notes.push_back("the robot is " + robot + ", its LiDAR " + sensor + " stands at x y z " +
                           fixed(at.x(), 2) + ' ' + fixed(at.y(), 2) + ' ' + fixed(at.z(), 2) +
                           " m; --sensor-pose replaces that");
    return;
  }
  folder.notes.push_back("no static transform from " + robot + " to " + sensor +
                         " (/tf is not read): the LiDAR is taken for the robot" +
                         (hasOdometry ? ", so poles are put wrong in curves if the odometry is "
                                        "that of another place"
                                      : "") +
                         "; --sensor-pose states its pose");
}

RosOdometry firstOdometry(const Bag& bag, std::size_t topic) {
  const BagMessage first = bag.messages(topic).front();
  return decodeOdometry(bag.read(first), bag.place(first));
}

/// Clouds that a LiDAR odometry has moved have lost the place they were seen from.
void requireOwnFrame(const Bag& bag, std::size_t clouds, const std::string& frame,
                     const RosOdometry& motion) {
  if (frame.empty() || frame == motion.child || frame != motion.header.frame) return;
  throw Error(bag.path().string() + ": " + bag.topics()[clouds].name + ": these clouds are in " +
              frame +
              ", the frame of the odometry, so they were moved; take the topic of the "
              "LiDAR's driver with --cloud-topic");
}

/// What a bag without odometry may have instead.
void noteTransforms(const Bag& bag, ScanFolder& folder) {
  for (const BagTopic& topic : bag.topics())
    if (topic.type == kTransformsType && topic.name == "/tf" && topic.messages > 0)
      folder.notes.push_back(
          "the " + std::to_string(topic.messages) +
          " messages of /tf are not read: if they hold the odometry, write it as a table in TUM "
          "format, for --odometry");
}

/// The root of the mean of the two horizontal variances; where none are stated, kAssumedFixSigma.
double sigmaOf(const RosNavSatFix& message) {
  const double variance = (message.covariance(0, 0) + message.covariance(1, 1)) / 2;
  const bool isStated = message.covarianceType > 0 && std::isfinite(variance) && variance > 0;
  return isStated ? std::sqrt(variance) : kAssumedFixSigma;
}

/// Adds the fixes of a topic, with a note. Messages without a fix are left out; without a static
/// transform to the frame of the fixes, the antenna is taken to be at the robot.
void addRosbagFixes(const Bag& bag, std::size_t topic, const FrameTree& frames,
                    const std::string& robot, ScanFolder& folder) {
  for (const BagMessage& message : bag.messages(topic)) {
    const RosNavSatFix read = decodeNavSatFix(bag.read(message), bag.place(message));
    if (read.status < 0) continue;
    GnssFix fix;
    fix.time = read.header.time;
    fix.latitude = read.latitude;
    fix.longitude = read.longitude;
    fix.sigma = sigmaOf(read);
    if (const auto T_robot_antenna = frames.find(robot, read.header.frame))
      fix.antenna_robot = T_robot_antenna->translation().head<2>();
    takeFix(fix, folder);
  }
  finishFixes(bag.topics()[topic].name, folder);
}

/// Adds the positions from satellites. They are optional: of several topics none is taken, with a
/// note.
void findFixes(const Bag& bag, const std::string& name, const FrameTree& frames,
               const std::string& robot, ScanFolder& folder) {
  std::optional<std::size_t> topic;
  if (name.empty() && topicsOf(bag, kFixType).size() > 1)
    folder.notes.push_back("several topics of " + std::string(kFixType) + ": " +
                           listTopics(bag, kFixType) + "; none is used, choose with --gnss-topic");
  else
    topic = chooseTopic(bag, kFixType, name, "--gnss-topic");
  if (topic) addRosbagFixes(bag, *topic, frames, robot, folder);
}

}  // namespace

ScanFolder readRosbag2(const fs::path& path, const Rosbag2Options& options) {
  const auto bag = std::make_shared<const Bag>(path);
  const auto clouds = chooseTopic(*bag, kCloudType, options.topics.cloud, "--cloud-topic");
  if (!clouds)
    throw Error(path.string() + ": no clouds: a topic of " + kCloudType + " is needed, it has " +
                listTopics(*bag) + "; packets of a LiDAR become clouds in its driver");
  const bool ignoresOdometry = !options.readsOdometry && options.topics.odometry.empty() &&
                               topicsOf(*bag, kOdometryType).size() > 1;
  std::optional<std::size_t> odometry;
  if (!ignoresOdometry)
    odometry = chooseTopic(*bag, kOdometryType, options.topics.odometry, "--odometry-topic");
  std::optional<std::size_t> imu;
  if (!options.topics.imu.empty()) {
    imu = chooseTopic(*bag, kImuType, options.topics.imu, "--imu-topic");
    if (!odometry)
      throw Error(path.string() + ": --imu-topic gives the yaw only, and there is no topic of " +
                  kOdometryType + "; leave --imu-topic out");
  }
  std::string sensor, robot = kDefaultRobotFrame;
  ScanFolder folder = listScans(*bag, *clouds, sensor);
  const std::vector<std::string> notes = bag->notes();
  folder.notes.insert(folder.notes.begin(), notes.begin(), notes.end());
  const FrameTree frames = readFrames(*bag, folder.notes);
  if (odometry) {
    const RosOdometry first = firstOdometry(*bag, *odometry);
    requireOwnFrame(*bag, *clouds, sensor, first);
    if (!first.child.empty()) robot = first.child;
    if (options.readsOdometry) addRosbagMotions(*bag, *odometry, imu, frames, folder);
  } else if (options.readsOdometry) {
    noteTransforms(*bag, folder);
  }
  findFixes(*bag, options.topics.fixes, frames, robot, folder);
  if (options.readsSensorPose) findSensorPose(frames, robot, sensor, odometry.has_value(), folder);
  if (options.readsTiming) estimateTiming(*bag, *clouds, folder);
  folder.read = [bag, topic = *clouds](const ScanEntry& scan) {
    return readScan(*bag, topic, scan, false).cloud;
  };
  return folder;
}

}  // namespace polemcl::io
