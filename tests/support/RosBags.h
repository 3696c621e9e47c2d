#pragma once
// Writes ROS 2 bags byte by byte, as the formats are published.

#include <sqlite3.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace polemcl::tests {

/// One message in CDR. Each number is aligned to its size.
class CdrWriter {
 public:
  explicit CdrWriter(bool bigEndian = false) : m_bigEndian(bigEndian) {}
  template <class T>
  CdrWriter& put(T value) {
    while (m_content.size() % sizeof(T) > 0) m_content += '\0';
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));  // tests run on little-endian machines
    for (std::size_t i = 0; i < sizeof(T); ++i)
      m_content += bytes[m_bigEndian ? sizeof(T) - 1 - i : i];
    return *this;
  }
  CdrWriter& text(const std::string& value) {
    put(static_cast<std::uint32_t>(value.size() + 1));
    m_content += value + '\0';
    return *this;
  }
  CdrWriter& bytes(const std::string& value) {
    put(static_cast<std::uint32_t>(value.size()));
    m_content += value;
    return *this;
  }
  CdrWriter& header(double time, const std::string& frame) {
    const double whole = std::floor(time);
    put(static_cast<std::int32_t>(whole));
    put(static_cast<std::uint32_t>(std::lround((time - whole) * 1e9)));
    return text(frame);
  }
  CdrWriter& zeros(std::size_t doubles) {
    for (std::size_t i = 0; i < doubles; ++i) put(0.0);
    return *this;
  }
  /// x, y, z and a quaternion that turns about z.
  CdrWriter& pose(double x, double y, double z, double yaw) {
    put(x).put(y).put(z).put(0.0).put(0.0);
    return put(std::sin(yaw / 2)).put(std::cos(yaw / 2));
  }
  std::string message() const {
    return std::string("\0", 1) + (m_bigEndian ? '\0' : '\1') + std::string(2, '\0') + m_content;
  }

 private:
  std::string m_content;
  bool m_bigEndian;
};

struct TestOdometry {
  double time = 0, x = 0, y = 0, yaw = 0;
  std::array<double, 3> variances{0.04, 0.01, 0.0025};  ///< (vx, vy, yaw rate)
  std::string child = "base_link", frame = "odom";
  double speed = 0;   ///< each of the six velocities
  bool down = false;  ///< the z axis of the child points down; yaw is 0 then
};

inline std::string odometryMessage(const TestOdometry& odometry, bool bigEndian = false) {
  CdrWriter writer(bigEndian);
  writer.header(odometry.time, odometry.frame).text(odometry.child);
  if (odometry.down)
    writer.put(odometry.x).put(odometry.y).put(0.0).put(1.0).zeros(3).zeros(36);
  else
    writer.pose(odometry.x, odometry.y, 0, odometry.yaw).zeros(36);
  for (int i = 0; i < 6; ++i) writer.put(odometry.speed);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column) {
      const int index = row < 2 ? row : row == 5 ? 2 : -1;
      writer.put(row == column && index >= 0 ? odometry.variances[static_cast<std::size_t>(index)]
                                             : 0.0);
    }
  return writer.message();
}

/// \param rate Angular velocity about x, y, z, rad/s. \param variance The same for each.
inline std::string imuMessage(double time, const std::string& frame,
                              const std::array<double, 3>& rate, double variance) {
  CdrWriter writer;
  writer.header(time, frame).zeros(4 + 9);
  for (const double component : rate) writer.put(component);
  for (int i = 0; i < 9; ++i) writer.put(i % 4 == 0 ? variance : 0.0);
  return writer.zeros(3 + 9).message();
}

struct TestFix {
  double time = 0, latitude = 0, longitude = 0;  ///< s, deg
  std::array<double, 2> variances{4, 9};         ///< east, north, m²
  std::uint8_t covarianceType = 2;
  std::int8_t status = 0;
  std::string frame = "gnss";
};

inline std::string fixMessage(const TestFix& fix, bool bigEndian = false) {
  CdrWriter writer(bigEndian);
  writer.header(fix.time, fix.frame).put(fix.status).put(std::uint16_t{1});
  writer.put(fix.latitude).put(fix.longitude).put(110.0);
  for (int i = 0; i < 9; ++i)
    writer.put(i == 0 ? fix.variances[0] : i == 4 ? fix.variances[1] : i == 8 ? 100.0 : 0.5);
  return writer.put(fix.covarianceType).message();
}

struct TestTransform {
  std::string parent, child;
  double x = 0, y = 0, z = 0, yaw = 0;
};

inline std::string transformsMessage(const std::vector<TestTransform>& transforms) {
  CdrWriter writer;
  writer.put(static_cast<std::uint32_t>(transforms.size()));
  for (const auto& t : transforms)
    writer.header(0, t.parent).text(t.child).pose(t.x, t.y, t.z, t.yaw);
  return writer.message();
}

struct TestField {
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t type = 7;  ///< float32
};

/// A cloud as its message states it.
struct TestCloud {
  double time = 0;
  std::string frame = "lidar";
  std::vector<TestField> fields{{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"intensity", 12, 7}};
  std::uint32_t pointBytes = 16, height = 1, width = 0;
  std::uint32_t rowBytes = 0;  ///< 0: width times pointBytes
  std::string data;
  bool bigEndian = false;  ///< message and data

  /// Appends a number to the data.
  template <class T>
  TestCloud& put(T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i) data += bytes[bigEndian ? sizeof(T) - 1 - i : i];
    return *this;
  }
  /// Appends x, y, z and intensity.
  TestCloud& point(float x, float y, float z, float intensity) {
    ++width;
    return put(x).put(y).put(z).put(intensity);
  }
  std::string message() const {
    CdrWriter writer(bigEndian);
    writer.header(time, frame).put(height).put(width);
    writer.put(static_cast<std::uint32_t>(fields.size()));
    for (const auto& field : fields)
      writer.text(field.name).put(field.offset).put(field.type).put(std::uint32_t{1});
    writer.put(static_cast<std::uint8_t>(bigEndian)).put(pointBytes);
    writer.put(rowBytes > 0 ? rowBytes : width * pointBytes).bytes(data);
    return writer.put(std::uint8_t{1}).message();
  }
};

/// A turn of a LiDAR with one ring: points at 10 m, each with its time since the stamp, float32.
/// \param sign 1: counter-clockwise. \param cut Azimuth of the first point, rad. \param begin Time
/// of the first point since the stamp, s.
inline TestCloud turningCloud(double time, int sign, double cut, double begin, double seconds) {
  constexpr int points = 1800;
  TestCloud cloud;
  cloud.time = time;
  cloud.fields.push_back({"time", 16, 7});
  cloud.pointBytes = 20;
  for (int i = 0; i < points; ++i) {
    const double turned = i / static_cast<double>(points);
    const double azimuth = cut + sign * 2 * M_PI * turned;
    cloud.point(static_cast<float>(10 * std::cos(azimuth)),
                static_cast<float>(10 * std::sin(azimuth)), 1, 7);
    cloud.put(static_cast<float>(begin + seconds * turned));
  }
  return cloud;
}

/// One `.db3` file.
class TestBag {
 public:
  explicit TestBag(const std::filesystem::path& file) {
    std::filesystem::create_directories(file.parent_path());
    std::filesystem::remove(file);
    if (sqlite3_open(file.c_str(), &m_database) != SQLITE_OK) throw std::runtime_error("sqlite");
    run("PRAGMA synchronous = OFF");
    run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)");
    run("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
        "timestamp INTEGER NOT NULL, data BLOB NOT NULL)");
    run("CREATE INDEX timestamp_idx ON messages (timestamp ASC)");
  }
  ~TestBag() { sqlite3_close(m_database); }
  TestBag(const TestBag&) = delete;
  TestBag& operator=(const TestBag&) = delete;

  int topic(const std::string& name, const std::string& type, const std::string& format = "cdr") {
    run("INSERT INTO topics(name, type, serialization_format, offered_qos_profiles) VALUES('" +
        name + "', '" + type + "', '" + format + "', '')");
    return static_cast<int>(sqlite3_last_insert_rowid(m_database));
  }
  /// \param recorded Time of recording, ns.
  void add(int topic, std::int64_t recorded, const std::string& message) {
    sqlite3_stmt* statement = nullptr;
    sqlite3_prepare_v2(m_database,
                       "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", -1,
                       &statement, nullptr);
    sqlite3_bind_int(statement, 1, topic);
    sqlite3_bind_int64(statement, 2, recorded);
    sqlite3_bind_blob(statement, 3, message.data(), static_cast<int>(message.size()),
                      SQLITE_TRANSIENT);
    const int status = sqlite3_step(statement);
    sqlite3_finalize(statement);
    if (status != SQLITE_DONE) throw std::runtime_error("sqlite");
  }
  void run(const std::string& sql) {
    if (sqlite3_exec(m_database, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
      throw std::runtime_error("sqlite: " + sql);
  }

 private:
  sqlite3* m_database = nullptr;
};

/// A `metadata.yaml` as rosbag2 writes it.
inline std::string bagMetadata(const std::vector<std::string>& files,
                               const std::string& compression = "\"\"",
                               const std::string& mode = "\"\"",
                               const std::string& storage = "sqlite3") {
  std::string text =
      "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: " + storage +
      "\n  topics_with_message_count:\n    - topic_metadata:\n        name: /points\n"
      "      message_count: 4\n  compression_format: " +
      compression + "\n  compression_mode: " + mode + "\n  relative_file_paths:\n";
  for (const auto& file : files) text += "    - " + file + '\n';
  return text + "  files:\n    - path: other.db3\n";
}

constexpr const char *pointCloud2 = "sensor_msgs/msg/PointCloud2",
                     *odometry2 = "nav_msgs/msg/Odometry", *imu2 = "sensor_msgs/msg/Imu",
                     *transforms2 = "tf2_msgs/msg/TFMessage", *fix2 = "sensor_msgs/msg/NavSatFix";

}  // namespace polemcl::tests
