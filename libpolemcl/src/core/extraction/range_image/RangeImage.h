#pragma once
/// \file RangeImage.h
/// \brief Step A of the paper: points -> rows x columns of range (Dong et al. 2021, Eq. 1).

#include <cmath>
#include <cstdint>
#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief Geometry of the paper's spherical image. `[range_image]` in INI files.
struct ProjectionOptions {
  int rows = 64;             ///< px
  int columns = 500;         ///< px over the full turn
  double fovUp = 0.0524;     ///< elevation of the upper border, rad (`fov_up_deg`)
  double fovDown = -0.436;   ///< elevation of the lower border, rad, negative below the horizon
  double minRange = 0.5;     ///< m; nearer points are the vehicle itself
  double maxRange = 50;      ///< m; points must be nearer
  bool clampToView = false;  ///< points outside the image go to its border pixels; false: dropped
  bool mirrored = false;     ///< y counts to the right in the image, as in the authors' NCLT frame
  bool singlePrecision = false;  ///< Eq. 1 is computed in float
  double coordinateStep = 0;     ///< m; see exactCoordinate()
  void validate() const;         ///< \throws Error naming the field
};

/// \brief What happened to the points of one cloud. They add up to the size of the cloud.
struct PointCounts {
  std::size_t used = 0;        ///< nearest of their pixel
  std::size_t hidden = 0;      ///< farther than another point of their pixel
  std::size_t invalid = 0;     ///< NaN, infinite, or at the origin
  std::size_t outOfView = 0;   ///< above or below the field of view
  std::size_t outOfRange = 0;  ///< nearer than minRange, farther than maxRange, or cut by height
};

/// \brief The range image. Row 0 is the topmost beam; column 0 looks to -x and azimuth *decreases*
/// with the column (u = ½[1 - atan2(y,x)/pi]·w), column w-1 neighbours column 0.
/// Index of a pixel: row * columns + column. Invalid pixels: range 0, point -1.
class RangeImage {
 public:
  RangeImage(int rows, int columns);
  int rows() const { return m_rows; }
  int columns() const { return m_columns; }
  float range(int row, int column) const { return m_range[index(row, column)]; }
  /// \brief Index in the cloud of the point that made the pixel, -1 if none.
  std::int32_t point(int row, int column) const { return m_point[index(row, column)]; }
  bool valid(int row, int column) const { return m_point[index(row, column)] >= 0; }
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * m_columns + column;
  }
  /// \brief Column wrapped into [0, columns): the image closes at ±180°.
  int wrap(int column) const {
    return column < 0 ? column + m_columns : column >= m_columns ? column - m_columns : column;
  }
  void set(int row, int column, float range, std::int32_t point);
  void clear();

 private:
  int m_rows, m_columns;
  std::vector<float> m_range;
  std::vector<std::int32_t> m_point;
};

/// \brief A coordinate (m) before it was rounded to float: the nearest multiple of `step`, for
/// files that hold such multiples (NCLT: 0.005 m). Step 0: the coordinate as it is.
inline double exactCoordinate(float value, double step) {
  return step > 0 ? std::nearbyint(value / step) * step : value;
}

/// \brief Projects the points (Eq. 1 with f_up + f_down = fovUp - fovDown); the nearest point wins,
/// of equally near ones the first.
/// \param points In the frame of the projection, z up.
/// \param minZ,maxZ Points must lie strictly between (same frame); pass ∓infinity for no cut.
PointCounts project(const PointsView& points, const ProjectionOptions& options, double minZ,
                    double maxZ, RangeImage& image);

}  // namespace polemcl
