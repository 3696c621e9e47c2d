#include "mrpt/observation/ObservationPoints.h"

#include <mrpt/io/lazy_load_path.h>
#include <mrpt/maps/CPointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/obs/VelodyneCalibration.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <numeric>

#include <polemcl/io/data/Cloud.h>
#include "core/common/Statistics.h"
#include "core/sensor/SensorModel.h"
#include "io/file/ReadLimits.h"
#include "mrpt/common/AllocationLimit.h"
#include "mrpt/common/BoundedRead.h"
#include "mrpt/common/MrptReason.h"

namespace polemcl {

using namespace mrpt::obs;

bool ObservationPoints::canRead(const CObservation& observation) {
  return dynamic_cast<const CObservationPointCloud*>(&observation) ||
         dynamic_cast<const CObservationVelodyneScan*>(&observation) ||
         dynamic_cast<const CObservation3DRangeScan*>(&observation) ||
         dynamic_cast<const CObservationRotatingScan*>(&observation);
}

PointsView ObservationPoints::read(const CObservation& observation) {
  release();
  m_dropped = 0;
  m_camera.reset();
  m_timing.reset();
  try {
    return pointsOf(observation);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(std::string("points of a ") + observation.GetRuntimeClass()->className +
                " cannot be read: " + mrptReason(error.what()));
  }
}

PointsView ObservationPoints::pointsOf(const CObservation& observation) {
  if (const auto* cloud = dynamic_cast<const CObservationPointCloud*>(&observation))
    return readCloud(*cloud);
  if (const auto* scan = dynamic_cast<const CObservationVelodyneScan*>(&observation))
    return readVelodyne(*scan);
  if (const auto* depth = dynamic_cast<const CObservation3DRangeScan*>(&observation))
    return readDepth(*depth);
  if (const auto* scan = dynamic_cast<const CObservationRotatingScan*>(&observation))
    return readRotating(*scan);
  throw Error(refusalOf(observation));
}

std::string ObservationPoints::refusalOf(const CObservation& observation) {
  const std::string what =
      std::string("no poles can be extracted from a ") + observation.GetRuntimeClass()->className;
  if (dynamic_cast<const CObservation2DRangeScan*>(&observation))
    return what +
           ": one plane does not show how high a thing is, so a leg or a corner looks like a pole; "
           "a LiDAR with several rings or a depth camera is needed";
  return what +
         "; allowed are CObservationPointCloud, CObservationVelodyneScan, CObservation3DRangeScan "
         "and CObservationRotatingScan";
}

void ObservationPoints::release() noexcept {
  try {
    if (m_loaded) m_loaded->unload();
  } catch (const std::exception&) {
    // Unloading only frees memory; read() has already reported unreadable data.
  }
  m_loaded = nullptr;
}

namespace {

/// The class hides its format, but classes derived from it have access.
struct StorageFormat : CObservationPointCloud {
  static ExternalStorageFormat of(const CObservationPointCloud& observation) {
    return observation.*(&StorageFormat::m_externally_stored);
  }
};

/// As StorageFormat. MRPT's own functions use the flags as if they were 0 or 1.
struct StorageFlags : CObservation3DRangeScan {
  static bool ofPoints(const CObservation3DRangeScan& scan) {
    return storedNumber(scan.*(&StorageFlags::m_points3D_external_stored)) != 0;
  }
  static bool ofImage(const CObservation3DRangeScan& scan) {
    return storedNumber(scan.*(&StorageFlags::m_rangeImage_external_stored)) != 0;
  }
};

/// Bytes of a file beside the rawlog; 0 if it is missing, which the one who reads it reports.
std::uintmax_t sizeOfExternal(const std::string& file) {
  std::error_code none;
  const auto status = std::filesystem::status(file, none);
  if (!std::filesystem::exists(status)) return 0;
  if (!std::filesystem::is_regular_file(status))
    throw Error(file +
                ": a scan beside the rawlog must be a regular file, no device, pipe or folder");
  return std::filesystem::file_size(file);
}

/// Lets MRPT read files beside the rawlog, whose counts may be wrong.
template <class Load>
void loadExternal(const std::vector<std::string>& files, const Load& load) {
  std::uint64_t bytes = 0;
  for (const std::string& file : files) bytes += sizeOfExternal(file);
  const AllocationLimit limit(io::mostInflated(bytes));
  try {
    load();
  } catch (const std::exception&) {
    if (!limit.reached()) throw;
    throw Error(files.front() + ": is damaged: it cannot hold as much as it says");
  }
}

std::vector<std::string> externalFilesOf(const CObservation3DRangeScan& scan) {
  std::vector<std::string> files;
  if (StorageFlags::ofPoints(scan))
    files.push_back(scan.points3D_getExternalStorageFileAbsolutePath());
  if (!StorageFlags::ofImage(scan)) return files;
  files.push_back(scan.rangeImage_getExternalStorageFileAbsolutePath(""));
  for (const auto& layer : scan.rangeImageOtherLayers)
    files.push_back(scan.rangeImage_getExternalStorageFileAbsolutePath(layer.first));
  return files;
}

/// Microseconds since the full hour. MRPT's gps_timestamp() binds a reference to this misaligned
/// member, which is undefined.
std::uint32_t timestampOf(const CObservationVelodyneScan::TVelodyneRawPacket& packet) {
  std::uint32_t stamp = 0;
  std::memcpy(&stamp, reinterpret_cast<const char*>(&packet) + sizeof packet.blocks, sizeof stamp);
  return mrpt::toNativeEndianness(stamp);
}

std::uint32_t between(const CObservationVelodyneScan::TVelodyneRawPacket& earlier,
                      const CObservationVelodyneScan::TVelodyneRawPacket& later) {
  constexpr std::uint32_t kWholeHour = 3'600'000'000;  // microseconds
  const std::uint32_t from = timestampOf(earlier), to = timestampOf(later);
  return to >= from ? to - from : to + kWholeHour - from;
}

/// Measuring times by the packets: the time stamp is that of the first firing, and azimuths of the
/// device are clockwise. None if the packets do not show a turn (fewer than two, no clock, one that
/// was set, packets that changed places).
std::optional<ScanTiming> timingOf(
    const std::vector<CObservationVelodyneScan::TVelodyneRawPacket>& packets) {
  constexpr int kFullTurn = 36000;       // 1/100 degree
  constexpr double kLongestPause = 0.5;  // between two packets, s
  if (packets.size() < 2) return std::nullopt;
  const auto rotation = [&](std::size_t i) { return packets[i].blocks[0].rotation() % kFullTurn; };
  double turned = 0, seconds = 0;
  for (std::size_t i = 1; i < packets.size(); ++i) {
    turned += (rotation(i) - rotation(i - 1) + kFullTurn) % kFullTurn;
    const double pause = between(packets[i - 1], packets[i]) * 1e-6;
    if (pause > kLongestPause) return std::nullopt;
    seconds += pause;
  }
  if (!(turned > 0 && seconds > 0)) return std::nullopt;
  return ScanTiming{Turn::clockwise, seconds * kFullTurn / turned,
                    -rotation(0) * 2 * M_PI / kFullTurn, 0};
}

/// Measuring times by the columns of the image; none if the scan does not state its duration.
std::optional<ScanTiming> timingOf(const CObservationRotatingScan& scan, bool clockwise) {
  if (!(scan.sweepDuration > 0) || scan.azimuthSpan == 0) return std::nullopt;
  const double begin = clockwise ? -scan.startAzimuth : scan.startAzimuth;
  const bool left = (scan.azimuthSpan > 0) != clockwise;
  return ScanTiming{left ? Turn::counterclockwise : Turn::clockwise,
                    scan.sweepDuration * 2 * M_PI / std::abs(scan.azimuthSpan), begin, 0};
}

bool endsIn(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Number of columns of a rotating scan that hold data. MRPT 2.5.8 converts Velodyne scans to
/// images that are too wide by a factor equal to the number of lasers; the rest is empty.
int usedColumns(const CObservationRotatingScan& scan) {
  const auto& ranges = scan.rangeImage;
  const int columns = static_cast<int>(ranges.cols()), rows = static_cast<int>(ranges.rows());
  const int narrow = columns / rows;
  for (int column = narrow; column < columns; ++column)
    for (int row = 0; row < rows; ++row)
      if (ranges(row, column) != 0) return columns;
  return narrow;
}

/// Lasers of a VLP-16 or an HDL-32E. MRPT loads them when they are asked for, which two threads
/// must not do at once.
const std::vector<VelodyneCalibration::PerLaserCalib>& lasersOf(bool isVlp16) {
  static const std::array<VelodyneCalibration, 2> known{
      VelodyneCalibration::LoadDefaultCalibration("HDL32"),
      VelodyneCalibration::LoadDefaultCalibration("VLP16")};
  return known[isVlp16 ? 1 : 0].laser_corrections;
}

/// Whether MRPT made the scan from a Velodyne scan. Rings are then in firing order, and azimuth is
/// clockwise as on the device.
bool isVelodyne(const CObservationRotatingScan& scan) {
  return scan.lidarModel == "VLP-16" || scan.lidarModel == "HDL-32E";
}

}  // namespace

PointsView ObservationPoints::readCloud(const CObservationPointCloud& observation) {
  if (!observation.pointcloud && observation.isExternallyStored()) {
    const std::string file =
        mrpt::io::lazy_load_absolute_path(observation.getExternalStorageFile());
    sizeOfExternal(file);  // refuses devices
    const auto format = StorageFormat::of(observation);
    if (format == CObservationPointCloud::ExternalStorageFormat::KittiBinFile &&
        !endsIn(file, ".gz")) {
      io::Cloud cloud = io::readKittiBin(file);  // stricter, and three times as fast
      m_x.swap(cloud.x);
      m_y.swap(cloud.y);
      m_z.swap(cloud.z);
      m_dropped = cloud.invalid;
      return owned();
    }
    m_loaded = &observation;
    loadExternal({file}, [&] { observation.load(); });
  }
  if (!observation.pointcloud) return {};
  const auto& points = *observation.pointcloud;
  const auto& x = points.getPointsBufferRef_x();
  return {x.data(), points.getPointsBufferRef_y().data(), points.getPointsBufferRef_z().data(),
          x.size()};
}

PointsView ObservationPoints::readVelodyne(const CObservationVelodyneScan& observation) {
  m_timing = timingOf(observation.scan_packets);
  const auto& own = observation.point_cloud;
  if (own.size() > 0 || observation.scan_packets.empty())
    return {own.x.data(), own.y.data(), own.z.data(), own.size()};
  readVelodynePackets(observation, m_velodyne);
  const auto& points = m_velodyne;
  return {points.x.data(), points.y.data(), points.z.data(), points.x.size()};
}

/// Prefers the image, the raw data of the camera: a cloud beside it may be thinned or in another
/// frame.
PointsView ObservationPoints::readDepth(const CObservation3DRangeScan& observation) {
  const std::vector<std::string> files = externalFilesOf(observation);
  std::optional<CObservation3DRangeScan> copy;
  if (!files.empty()) loadExternal(files, [&] { copy.emplace(observation).load(); });
  const CObservation3DRangeScan& scan = copy ? *copy : observation;
  if (hasPixels(scan)) {
    m_camera = cameraOf(scan);
    m_pixels.prepare(scan, *m_camera);
    m_dropped = unproject(scan, *m_camera, m_pixels, {m_x, m_y, m_z});
    return owned();
  }
  if (storedNumber(scan.hasPoints3D) == 0) return {};
  m_x.assign(scan.points3D_x.begin(), scan.points3D_x.end());
  m_y.assign(scan.points3D_y.begin(), scan.points3D_y.end());
  m_z.assign(scan.points3D_z.begin(), scan.points3D_z.end());
  return owned();
}

std::vector<double> ObservationPoints::rowElevations(const CObservationRotatingScan& scan) const {
  const int rows = static_cast<int>(scan.rangeImage.rows());
  SensorOptions upright = m_sensor;
  upright.upsideDown = false;                           // the sensor pose turns the points
  std::vector<double> elevations = upright.elevations;  // `table`: in the order of the rings
  if (upright.model != "table") {
    const SensorModel model(upright);  // topmost first
    elevations.resize(static_cast<std::size_t>(model.beamCount()));
    for (int row = 0; row < model.beamCount(); ++row)
      elevations[static_cast<std::size_t>(row)] = std::atan(model.beam(row).slope);
  }
  if (static_cast<int>(elevations.size()) != rows)
    throw Error("a rotating scan of " + std::to_string(rows) + " rows (" + scan.lidarModel +
                ") does not state its elevations, and [sensor] model = " + m_sensor.model +
                " has " + std::to_string(elevations.size()) +
                " beams; set the model, or model = table with elevations_deg in the order of the "
                "rows");
  if (!isVelodyne(scan) || upright.model == "table") return elevations;
  const auto& lasers = lasersOf(scan.lidarModel == "VLP-16");
  if (lasers.size() != elevations.size())
    throw Error("a rotating scan names the model " + scan.lidarModel + " but has " +
                std::to_string(rows) + " rows");
  // The configuration gives the elevations; the calibration only gives the vertical order of the
  // lasers.
  std::vector<std::size_t> order(lasers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return lasers[a].verticalCorrection > lasers[b].verticalCorrection;
  });
  std::vector<double> byLaser(lasers.size());
  for (std::size_t i = 0; i < order.size(); ++i) byLaser[order[i]] = elevations[i];
  return byLaser;
}

PointsView ObservationPoints::readRotating(const CObservationRotatingScan& scan) {
  m_x.clear();
  m_y.clear();
  m_z.clear();
  const auto& ranges = scan.rangeImage;
  if (ranges.rows() == 0 || ranges.cols() == 0) return owned();
  const std::vector<double> elevations = rowElevations(scan);
  const bool velodyne = isVelodyne(scan);
  m_timing = timingOf(scan, velodyne);
  const int columns = velodyne ? usedColumns(scan) : static_cast<int>(ranges.cols());
  for (int column = 0; column < columns; ++column) {
    const double turned = scan.startAzimuth + scan.azimuthSpan * column / columns;
    const double azimuth = velodyne ? -turned : turned;
    const double cosine = std::cos(azimuth), sine = std::sin(azimuth);
    for (std::size_t row = 0; row < elevations.size(); ++row) {
      const auto units = ranges(static_cast<int>(row), column);
      if (units == 0) continue;  // no return
      const double range = units * scan.rangeResolution;
      const double rho = range * std::cos(elevations[row]);
      m_x.push_back(static_cast<float>(rho * cosine));
      m_y.push_back(static_cast<float>(rho * sine));
      m_z.push_back(static_cast<float>(range * std::sin(elevations[row])));
    }
  }
  return owned();
}

std::string packetContradiction(const CObservation& observation) {
  constexpr std::size_t kFewest = 10;
  constexpr double kVlp16 = 24 * 55.296,
                   kHdl32e = 12 * 46.08;  // from packet to packet, microseconds
  const auto* scan = dynamic_cast<const CObservationVelodyneScan*>(&observation);
  if (!scan || scan->scan_packets.size() < kFewest) return {};
  std::vector<double> apart;
  for (std::size_t i = 1; i < scan->scan_packets.size(); ++i)
    apart.push_back(between(scan->scan_packets[i - 1], scan->scan_packets[i]));
  const double least = nearestRank(apart, 0.1);  // where packets are missing, others are longer
  const auto is = [least](double step) { return std::abs(least - step) < 0.03 * step; };
  const std::size_t lasers = scan->calibration.laser_corrections.size();
  std::string made;
  if (lasers == 16 && (is(kHdl32e) || is(kHdl32e / 2))) made = "HDL-32E";  // half: dual returns
  if (lasers == 32 && is(kVlp16)) made = "VLP-16";
  if (made.empty()) return {};
  return "its packets come every " + std::to_string(std::lround(least)) +
         " microseconds, as those of the " + made + " do, but are decoded for " +
         std::to_string(lasers) +
         " lasers: record with the model and the calibration_file of the LiDAR";
}

}  // namespace polemcl
