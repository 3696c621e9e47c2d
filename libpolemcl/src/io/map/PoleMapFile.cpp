#include "io/map/PoleMapFile.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/common/Covariance.h"
#include "core/common/PoleIndex.h"
#include "core/mapping/MapAccumulator.h"
#include "io/file/AtomicFile.h"
#include "io/file/Bytes.h"
#include "io/file/Decompress.h"

namespace polemcl::io {
namespace {

constexpr std::string_view polemapMagic("\x89PMAP\r\n\x1a", 8);
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeaderBytes = 8 + 4 + 8 + 4;
constexpr std::uint32_t kRecordBytes = 9 * 8 + 4;
constexpr std::uint32_t kHistoryBytes = 3 * 8 + 2 * 4;

std::uint32_t checksum(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/// Why the pole is invalid; null when it is valid.
const char* fault(const MapPole& pole) {
  for (const double value : {pole.x, pole.y, pole.radius, pole.bottom, pole.top, pole.confidence}) {
    if (!std::isfinite(value)) return "a value is not finite";
  }
  if (std::max(std::abs(pole.x), std::abs(pole.y)) > PoleIndex::farthest)
    return "the place is more than 1e9 m from the origin";
  if (pole.radius < 0) return "the radius is negative";
  if (pole.confidence < 0 || pole.confidence > 1) return "the confidence is outside 0 … 1";
  if (!pole.covariance.allFinite()) return "the covariance is not finite";
  if (!isCovariance(pole.covariance))
    return "the covariance is not symmetric positive semidefinite";
  if (pole.covariance.trace() > kGreatestVariance) return "the covariance is above 1e12 m²";
  return nullptr;
}

/// Why the history is invalid; null when it is valid.
const char* fault(const PoleHistory& history) {
  if (!(history.existence >= 0 && history.existence <= 1)) return "the existence is outside 0 … 1";
  for (const double time : {history.firstSeen, history.lastSeen}) {
    if (!(std::isfinite(time) && time >= 0)) return "a date is before 1970 or not finite";
  }
  return nullptr;
}

void require(const char* why, const std::string& where, const char* what, std::size_t i) {
  if (why) throw Error(where + what + std::to_string(i) + " (counted from 0): " + why);
}

void putChunk(ByteWriter& payload, std::string_view tag, std::string_view content) {
  payload.putRaw(tag);
  payload.put(static_cast<std::uint64_t>(content.size()));
  payload.putRaw(content);
}

void putPole(ByteWriter& record, const MapPole& p) {
  for (const double value : {p.x, p.y, p.radius, p.bottom, p.top, p.confidence, p.covariance(0, 0),
                             p.covariance(0, 1), p.covariance(1, 1)}) {
    record.put(value);
  }
  record.put(p.count);
}

void putHistory(ByteWriter& record, const PoleHistory& history) {
  for (const double value : {history.existence, history.firstSeen, history.lastSeen}) {
    record.put(value);
  }
  record.put(history.seen);
  record.put(history.missed);
}

std::string payloadOf(const PoleMapData& data, const AddedSessions* scans) {
  ByteWriter info, poles, candidates, payload;
  info.put(static_cast<std::uint32_t>(data.info.size()));
  for (const auto& [key, value] : data.info) {
    info.putText(key);
    info.putText(value);
  }
  poles.put(kRecordBytes + (data.histories.empty() ? 0 : kHistoryBytes));
  poles.put(static_cast<std::uint64_t>(data.poles.size()));
  for (std::size_t i = 0; i < data.poles.size(); ++i) {
    putPole(poles, data.poles[i]);
    if (!data.histories.empty()) putHistory(poles, data.histories[i]);
  }
  candidates.put(kRecordBytes + kHistoryBytes);
  candidates.put(static_cast<std::uint64_t>(data.candidates.size()));
  for (const LandmarkRecord& kept : data.candidates) {
    putPole(candidates, kept.pole);
    putHistory(candidates, kept.history);
  }
  putChunk(payload, "INFO", info.bytes());
  putChunk(payload, "POLE", poles.bytes());
  if (!data.candidates.empty()) putChunk(payload, "CAND", candidates.bytes());
  if (scans) putChunk(payload, "SCAN", packMapScans(*scans));
  return payload.bytes();
}

void readInfo(ByteReader& chunk, PoleMapData& data) {
  const auto count = chunk.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string key(chunk.getText());
    data.info[key] = chunk.getText();
  }
}

MapPole readRecord(ByteReader& record) {
  MapPole p;
  for (double* value : {&p.x, &p.y, &p.radius, &p.bottom, &p.top, &p.confidence,
                        &p.covariance(0, 0), &p.covariance(0, 1), &p.covariance(1, 1)}) {
    *value = record.get<double>();
  }
  p.covariance(1, 0) = p.covariance(0, 1);
  p.count = record.get<std::uint32_t>();
  return p;
}

PoleHistory readHistory(ByteReader& record) {
  PoleHistory history;
  for (double* value : {&history.existence, &history.firstSeen, &history.lastSeen}) {
    *value = record.get<double>();
  }
  history.seen = record.get<std::uint32_t>();
  history.missed = record.get<std::uint32_t>();
  return history;
}

/// Reads the records of a chunk. \return Whether they have histories.
bool readRecords(ByteReader& chunk, const std::string& where,
                 std::vector<LandmarkRecord>& records) {
  const auto size = chunk.get<std::uint32_t>();
  const auto count = chunk.get<std::uint64_t>();
  if (size < kRecordBytes || count > chunk.remaining() / size) {
    throw Error(where + "damaged: " + std::to_string(count) + " poles of " + std::to_string(size) +
                " bytes do not fit into " + std::to_string(chunk.remaining()));
  }
  const bool withHistory = size >= kRecordBytes + kHistoryBytes;
  records.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    ByteReader record(chunk.getRaw(size), where);
    LandmarkRecord& kept = records.emplace_back();
    kept.pole = readRecord(record);
    if (withHistory) kept.history = readHistory(record);
  }
  return withHistory;
}

void readPoles(ByteReader& chunk, const std::string& where, PoleMapData& data) {
  std::vector<LandmarkRecord> records;
  const bool withHistory = readRecords(chunk, where, records);
  for (const LandmarkRecord& record : records) {
    data.poles.push_back(record.pole);
    if (withHistory) data.histories.push_back(record.history);
  }
}

/// The payload of a whole file, after all checks.
std::string_view checkedPayload(std::string_view bytes, const std::string& where) {
  if (bytes.substr(0, polemapMagic.size()) != polemapMagic) {
    throw Error(where +
                "not a pole map (it does not start like a .polemap file); `pole-map convert` "
                "makes one of CSV, NPZ and GeoJSON");
  }
  ByteReader header(bytes.substr(polemapMagic.size()), where + "cut short: ");
  const auto found = header.get<std::uint32_t>();
  if (found != kVersion) {
    throw Error(where + "version " + std::to_string(found) + " of the format; this program reads " +
                std::to_string(kVersion) + ": update polemcl, or the file is damaged");
  }
  const auto size = header.get<std::uint64_t>();
  const auto crc = header.get<std::uint32_t>();
  if (size != header.remaining()) {
    throw Error(where + "cut short or damaged: " + std::to_string(header.remaining()) +
                " bytes after the header, " + std::to_string(size) + " expected");
  }
  const std::string_view payload = bytes.substr(kHeaderBytes);
  if (checksum(payload) != crc) throw Error(where + "damaged: the checksum (CRC-32) is wrong");
  return payload;
}

/// Calls use(tag, content, "FILE: ") for each chunk of a file.
template <class Use>
void eachChunk(const std::filesystem::path& file, const Use& use) {
  const std::string bytes = readBytes(file);
  const std::string where = file.string() + ": ";
  ByteReader payload(checkedPayload(bytes, where), where);
  while (payload.remaining() > 0) {
    const std::string_view tag = payload.getRaw(4);
    use(tag, payload.getRaw(payload.get<std::uint64_t>()), where);
  }
}

constexpr double kLatestTime = 1e11;  ///< s, some thousand years
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

/// Poses in the map, and poles, are checked when the scans are used.
void requireSound(const SessionScan& scan, const std::string& where) {
  const Pose2D& sensor = scan.pose_robot_sensor;
  if (!(std::abs(scan.time) <= kLatestTime))
    throw Error(where + "damaged: the time of a scan is not finite, or beyond 1e11 s");
  if (!(std::abs(sensor.x) <= PoleIndex::farthest && std::abs(sensor.y) <= PoleIndex::farthest &&
        std::isfinite(sensor.yaw)))
    throw Error(where + "damaged: a sensor of its scans is not at a finite place within 1e9 m");
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

void requireSound(const PoleMapData& data, const std::string& where) {
  if (!data.histories.empty() && data.histories.size() != data.poles.size()) {
    throw Error(where + std::to_string(data.histories.size()) + " histories for " +
                std::to_string(data.poles.size()) +
                " poles; allowed is one for each pole, or no history");
  }
  for (std::size_t i = 0; i < data.poles.size(); ++i)
    require(fault(data.poles[i]), where, "pole ", i);
  for (std::size_t i = 0; i < data.histories.size(); ++i)
    require(fault(data.histories[i]), where, "pole ", i);
  for (std::size_t i = 0; i < data.candidates.size(); ++i) {
    require(fault(data.candidates[i].pole), where, "candidate ", i);
    require(fault(data.candidates[i].history), where, "candidate ", i);
  }
}

LandmarkMap landmarkMap(const PoleMapData& data) {
  LandmarkMap map;
  if (data.histories.empty()) map = landmarksFrom(data.poles);
  for (std::size_t i = 0; i < data.histories.size(); ++i)
    map.poles.push_back({data.poles[i], data.histories[i], true});
  map.poles.insert(map.poles.end(), data.candidates.begin(), data.candidates.end());
  return map;
}

PoleMapData mapData(const LandmarkMap& map, std::map<std::string, std::string> info) {
  PoleMapData data;
  data.info = std::move(info);
  for (const LandmarkRecord& kept : map.poles) {
    if (!kept.present) {
      data.candidates.push_back(kept);
      continue;
    }
    data.poles.push_back(kept.pole);
    data.histories.push_back(kept.history);
  }
  return data;
}

void writePoleMap(const std::filesystem::path& file, const PoleMapData& data,
                  const AddedSessions* scans) {
  requireSound(data, "cannot write " + file.string() + ": ");
  const std::string payload = payloadOf(data, scans);
  ByteWriter header;
  header.putRaw(polemapMagic);
  header.put(kVersion);
  header.put(static_cast<std::uint64_t>(payload.size()));
  header.put(checksum(payload));
  writeFile(file, header.bytes() + payload);
}

PoleMapData readPoleMap(const std::filesystem::path& file, std::optional<AddedSessions>* scans) {
  PoleMapData data;
  bool hasPoles = false;
  eachChunk(file, [&](std::string_view tag, std::string_view content, const std::string& where) {
    ByteReader chunk(content, where);
    if (tag == "INFO") readInfo(chunk, data);
    if (tag == "POLE") readPoles(chunk, where, data);
    if (tag == "CAND" && !readRecords(chunk, where, data.candidates))
      throw Error(where + "damaged: its candidates have no histories");
    if (scans && tag == "SCAN") *scans = unpackMapScans(content, where);
    hasPoles = hasPoles || tag == "POLE";
  });
  if (!hasPoles) throw Error(file.string() + ": damaged: it has no list of poles");
  requireSound(data, file.string() + ": ");
  return data;
}

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
    for (SessionScan& scan : session.scans) {
      session.used.push_back(getScan(reader, where, scan));
      requireSound(scan, where);
    }
  }
  if (reader.remaining() == 0) return added;  // written by 1.0.0
  for (AddedSession& session : added.sessions) getCovariances(reader, where, session);
  return added;
}

}  // namespace polemcl::io
