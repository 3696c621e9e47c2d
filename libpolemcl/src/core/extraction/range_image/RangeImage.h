#pragma once
/// \file RangeImage.h
/// \brief Step A of the paper: points -> rows x columns of range (Dong et al. 2021, Eq. 1).

#include <cmath>
#include <cstdint>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/extraction/ExtractionOptions.h>

namespace polemcl {

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
/// \param options In range; of these, those of the image, the cuts and the coordinates are used.
/// \param minRange Nearer points are the vehicle itself, m.
/// \throws Error unless minRange is below the greatest range, and not negative.
/// \param heightOffset From z of the points to the heights that the options are meant in, m.
PointCounts project(const PointsView& points, const RangeImageOptions& options, double minRange,
                    double heightOffset, RangeImage& image);

}  // namespace polemcl
