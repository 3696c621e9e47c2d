#include "io/map/MapScans.h"

#include <zlib.h>

#include "core/common/Covariance.h"
#include "io/file/Bytes.h"
#include "io/file/Decompress.h"

namespace polemcl::io {
namespace {

constexpr std::uint64_t kScanBytes = 4 * 8 + 4, kPoleBytes = 10 * 8 + 4;  ///< smallest size of each

void put(ByteWriter& writer, const Pose2D& pose) {
  for (const double value : {pose.x, pose.y, pose.yaw}) writer.put(value);
}

void put(ByteWriter& writer, const PoleDetection& p) {
  const Eigen::Matrix2d& c = p.covariance;
  for (const double value :
       {p.x, p.y, p.radius, p.bottom, p.top, p.confidence, c(0, 0), c(0, 1), c(1, 0), c(1, 1)})
    writer.put(value);
  writer.put(p.points);
}

void put(ByteWriter& writer, const SessionScan& scan, bool used) {
  writer.put(scan.time);
  put(writer, scan.pose_map_robot);
  writer.put(static_cast<std::uint32_t>(used));
  if (!used) return;
  put(writer, scan.pose_robot_sensor);
  writer.put(static_cast<std::uint32_t>(scan.poles_robot.size()));
  for (const PoleDetection& pole : scan.poles_robot) put(writer, pole);
  writer.put(static_cast<std::uint32_t>(scan.visibilityRange.size()));
  for (const float range : scan.visibilityRange) writer.put(range);
}

/// Upper triangle, by rows.
void put(ByteWriter& writer, const Eigen::Matrix3d& c) {
  for (const double value : {c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)})
    writer.put(value);
}

std::string deflated(const std::string& bytes) {
  std::string result(compressBound(bytes.size()), '\0');
  uLongf size = result.size();
  if (compress2(reinterpret_cast<Bytef*>(result.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), 6) != Z_OK)
    throw Error("no memory left to compress the scans of a map");
  result.resize(size);
  return result;
}

/// Reads a count of entries that take at least `bytes` bytes each.
template <class Count>
Count countOf(ByteReader& reader, std::uint64_t bytes, const std::string& where) {
  const auto count = reader.get<Count>();
  if (count > reader.remaining() / bytes)
    throw Error(where + "damaged: " + std::to_string(count) + " entries do not fit into its scans");
  return count;
}

Pose2D getPose(ByteReader& reader) {
  Pose2D pose;
  for (double* value : {&pose.x, &pose.y, &pose.yaw}) *value = reader.get<double>();
  return pose;
}

PoleDetection getPole(ByteReader& reader) {
  PoleDetection p;
  Eigen::Matrix2d& c = p.covariance;
  for (double* value : {&p.x, &p.y, &p.radius, &p.bottom, &p.top, &p.confidence, &c(0, 0), &c(0, 1),
                        &c(1, 0), &c(1, 1)})
    *value = reader.get<double>();
  p.points = reader.get<std::uint32_t>();
  return p;
}

/// \return Whether the scan is used.
bool getScan(ByteReader& reader, const std::string& where, SessionScan& scan) {
  scan.time = reader.get<double>();
  scan.pose_map_robot = getPose(reader);
  const auto used = reader.get<std::uint32_t>();
  if (used > 1) throw Error(where + "damaged: a scan is neither used nor not");
  if (used == 0) return false;
  scan.pose_robot_sensor = getPose(reader);
  const auto poles = countOf<std::uint32_t>(reader, kPoleBytes, where);
  scan.poles_robot.reserve(poles);
  for (std::uint32_t i = 0; i < poles; ++i) scan.poles_robot.push_back(getPole(reader));
  scan.visibilityRange.resize(countOf<std::uint32_t>(reader, 4, where));
  for (float& range : scan.visibilityRange) range = reader.get<float>();
  return true;
}

Eigen::Matrix3d getCovariance(ByteReader& reader, const std::string& where) {
  Eigen::Matrix3d c;
  for (double* value : {&c(0, 0), &c(0, 1), &c(0, 2), &c(1, 1), &c(1, 2), &c(2, 2)})
    *value = reader.get<double>();
  c.triangularView<Eigen::StrictlyLower>() = c.transpose();
  if (!isCovariance(c)) throw Error(where + "damaged: the covariance of a pose is none");
  return c;
}

/// All scans of a session have one, or none.
void getCovariances(ByteReader& reader, const std::string& where, AddedSession& session) {
  const auto count = countOf<std::uint64_t>(reader, 6 * 8, where);
  if (count != 0 && count != session.scans.size())
    throw Error(where + "damaged: " + std::to_string(count) + " covariances of " +
                std::to_string(session.scans.size()) + " poses");
  for (std::uint64_t i = 0; i < count; ++i)
    session.covariances.push_back(getCovariance(reader, where));
}

}  // namespace

std::string packMapScans(const AddedSessions& added) {
  ByteWriter writer;
  writer.put(added.unvisited);
  writer.put(static_cast<std::uint32_t>(added.sessions.size()));
  for (const AddedSession& session : added.sessions) {
    writer.putText(session.name);
    writer.put(static_cast<std::uint64_t>(session.scans.size()));
    for (std::size_t i = 0; i < session.scans.size(); ++i)
      put(writer, session.scans[i], session.used.at(i));
  }
  for (const AddedSession& session : added.sessions) {
    writer.put(static_cast<std::uint64_t>(session.covariances.size()));
    for (const Eigen::Matrix3d& covariance : session.covariances) put(writer, covariance);
  }
  ByteWriter content;
  content.put(static_cast<std::uint64_t>(writer.bytes().size()));
  content.putRaw(deflated(writer.bytes()));
  return content.bytes();
}

AddedSessions unpackMapScans(std::string_view content, const std::string& where) {
  ByteReader packed(content, where);
  const auto size = packed.get<std::uint64_t>();
  const std::string bytes = inflated(packed.getRaw(packed.remaining()), size, where);
  ByteReader reader(bytes, where);
  AddedSessions added;
  added.unvisited = reader.get<double>();
  const auto sessions = countOf<std::uint32_t>(reader, 4 + 8, where);
  for (std::uint32_t i = 0; i < sessions; ++i) {
    AddedSession& session = added.sessions.emplace_back();
    session.name = reader.getText();
    const auto scans = countOf<std::uint64_t>(reader, kScanBytes, where);
    session.scans.resize(scans);
    session.used.reserve(scans);
    for (SessionScan& scan : session.scans) session.used.push_back(getScan(reader, where, scan));
  }
  if (reader.remaining() == 0) return added;  // written by 1.0.0
  for (AddedSession& session : added.sessions) getCovariances(reader, where, session);
  return added;
}

}  // namespace polemcl::io
