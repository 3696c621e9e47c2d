#pragma once
/// \file ObservationPoints.h
/// \brief The points of whatever observation of MRPT holds some.

#include <mrpt/obs/CObservation.h>

#include <optional>
#include <vector>

#include "core/common/Types.h"
#include "core/sensor/PinholeCamera.h"
#include "core/sensor/SensorOptions.h"

namespace mrpt::obs {
class CObservationPointCloud;
class CObservationVelodyneScan;
class CObservation3DRangeScan;
class CObservationRotatingScan;
}  // namespace mrpt::obs

namespace polemcl {

/// \brief Borrows the points of an observation where it has them in memory, else loads, unprojects
/// or generates them on a copy. One object serves one thread.
class ObservationPoints {
 public:
  /// \param sensor Elevations of the rows of rotating scans.
  explicit ObservationPoints(SensorOptions sensor) : m_sensor(std::move(sensor)) {}

  static bool canRead(const mrpt::obs::CObservation& observation);
  /// \brief Points in the frame of the observation's sensor pose; they may hold NaN and zeros.
  /// Valid until the next read() or release(), and as long as the observation lives. \throws Error
  /// on other classes, and when the points cannot be had.
  PointsView read(const mrpt::obs::CObservation& observation);
  /// \brief Invalid points of the last read() that are not in its view any more.
  std::size_t dropped() const { return m_dropped; }
  /// \brief The camera, with its attitude left as identity, when the points of the last read() are
  /// the pixels of a depth image.
  const std::optional<PinholeCamera>& camera() const { return m_camera; }
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
  PointsView readCloud(const mrpt::obs::CObservationPointCloud& observation);
  PointsView readVelodyne(const mrpt::obs::CObservationVelodyneScan& observation);
  PointsView readDepth(const mrpt::obs::CObservation3DRangeScan& observation);
  PointsView readRotating(const mrpt::obs::CObservationRotatingScan& observation);
  std::vector<double> rowElevations(const mrpt::obs::CObservationRotatingScan& observation) const;
  PointsView owned() const { return {m_x.data(), m_y.data(), m_z.data(), m_x.size()}; }

  SensorOptions m_sensor;
  std::vector<float> m_x, m_y, m_z;
  std::size_t m_dropped = 0;
  std::optional<PinholeCamera> m_camera;
  const mrpt::obs::CObservation* m_loaded = nullptr;  ///< to be unloaded
};

}  // namespace polemcl
