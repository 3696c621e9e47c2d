#pragma once
/// \file ObservationPoints.h
/// \brief The points of any MRPT observation with 3D points.

#include <mrpt/obs/CObservation.h>

#include <optional>
#include <string>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/sensor/SensorOptions.h>
#include "core/sensor/PinholeCamera.h"
#include "mrpt/observation/DepthImage.h"
#include "mrpt/observation/VelodynePoints.h"

namespace mrpt::obs {
class CObservationPointCloud;
class CObservation3DRangeScan;
class CObservationRotatingScan;
}  // namespace mrpt::obs

namespace polemcl {

/// \brief Gives access to the points of an observation. Points in memory are not copied. Otherwise
/// they are loaded, or computed on a copy. Use one object per thread.
class ObservationPoints {
 public:
  /// \param sensor Elevations for the rings of rotating scans.
  explicit ObservationPoints(SensorOptions sensor) : m_sensor(std::move(sensor)) {}

  static bool canRead(const mrpt::obs::CObservation& observation);
  /// \brief Why there are no points of poles in an observation that canRead() denies.
  static std::string refusalOf(const mrpt::obs::CObservation& observation);
  /// \brief Points in the frame of the observation's sensor pose; they may contain NaN and zeros.
  /// Valid until the next read() or release(), and as long as the observation exists.
  /// \throws Error for other classes, and when the points are not available.
  PointsView read(const mrpt::obs::CObservation& observation);
  /// \brief Number of invalid points of the last read() that are not in its result.
  std::size_t dropped() const { return m_dropped; }
  /// \brief The camera, with identity as attitude, if the points of the last read() are the pixels
  /// of a depth image.
  const std::optional<PinholeCamera>& camera() const { return m_camera; }
  /// \brief Measuring times, if the observation of the last read() states them.
  const std::optional<ScanTiming>& timing() const { return m_timing; }
  /// \brief Unloads what read() loaded from external storage.
  void release() noexcept;

  /// \brief Calls release() when it goes out of scope.
  class Loan {
   public:
    explicit Loan(ObservationPoints& points) : m_points(points) {}
    ~Loan() { m_points.release(); }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;

   private:
    ObservationPoints& m_points;
  };

 private:
  PointsView pointsOf(const mrpt::obs::CObservation& observation);
  PointsView readCloud(const mrpt::obs::CObservationPointCloud& observation);
  PointsView readVelodyne(const mrpt::obs::CObservationVelodyneScan& observation);
  PointsView readDepth(const mrpt::obs::CObservation3DRangeScan& observation);
  PointsView readRotating(const mrpt::obs::CObservationRotatingScan& observation);
  std::vector<double> rowElevations(const mrpt::obs::CObservationRotatingScan& observation) const;
  PointsView owned() const { return {m_x.data(), m_y.data(), m_z.data(), m_x.size()}; }

  SensorOptions m_sensor;
  std::vector<float> m_x, m_y, m_z;
  VelodynePoints m_velodyne;
  std::size_t m_dropped = 0;
  std::optional<PinholeCamera> m_camera;
  UndistortedPixels m_pixels;  ///< of the last depth image
  std::optional<ScanTiming> m_timing;
  const mrpt::obs::CObservation* m_loaded = nullptr;  ///< must be unloaded
};

/// \brief Says that packets of a Velodyne are decoded for another model, by the time between them
/// (manuals of VLP-16 and HDL-32E). \return Empty for other observations, other models, and where
/// nothing contradicts.
std::string packetContradiction(const mrpt::obs::CObservation& observation);

}  // namespace polemcl
