#include <polemcl/core/RangeImage.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace polemcl {

RangeImage::RangeImage(int rows, int columns)
    : m_rows(rows),
      m_columns(columns),
      m_range(static_cast<std::size_t>(rows) * columns, 0.f),
      m_point(static_cast<std::size_t>(rows) * columns, -1) {}

void RangeImage::set(int row, int column, float range, std::int32_t point) {
  m_range[index(row, column)] = range;
  m_point[index(row, column)] = point;
}

void RangeImage::clear() {
  std::fill(m_range.begin(), m_range.end(), 0.f);
  std::fill(m_point.begin(), m_point.end(), -1);
}

PointCounts project(const PointsView& points, const RangeImageOptions& options, double minZ,
                    double maxZ, RangeImage& image) {
  options.validate();
  image.clear();
  const double fov = options.fovUp - options.fovDown;
  PointCounts counts;
  for (std::size_t i = 0; i < points.size; ++i) {
    const double x = points.x[i], y = points.y[i], z = points.z[i];
    const double r = std::sqrt(x * x + y * y + z * z);
    if (!std::isfinite(r) || r == 0) {
      ++counts.invalid;
      continue;
    }
    if (r < options.minRange || r > options.maxRange || z < minZ || z > maxZ) {
      ++counts.outOfRange;
      continue;
    }
    // Eq. 1. The angle added is the one below the horizon, so that row 0 is the topmost beam.
    const double u = 0.5 * (1 - std::atan2(y, x) / M_PI) * image.columns();
    const double v = (1 - (std::asin(z / r) - options.fovDown) / fov) * image.rows();
    if (v < 0 || v >= image.rows()) {
      ++counts.outOfView;
      continue;
    }
    const int row = static_cast<int>(v);
    const int column = static_cast<int>(u) % image.columns();  // azimuth -pi is azimuth pi
    const float range = static_cast<float>(r);
    if (image.valid(row, column)) {
      ++counts.hidden;
      if (range >= image.range(row, column)) continue;
    } else {
      ++counts.used;
    }
    image.set(row, column, range, static_cast<std::int32_t>(i));
  }
  return counts;
}

void RangeImageOptions::validate() const {
  if (rows < 2 || rows > 1024 || columns < 16 || columns > 65536)
    throw Error("range image of " + std::to_string(rows) + " x " + std::to_string(columns) +
                ": allowed are 2 to 1024 rows and 16 to 65536 columns");
  if (!(fovUp > fovDown))
    throw Error(
        "range image: fov_up_deg must be more than fov_down_deg (negative below the horizon)");
  if (!(minRange >= 0 && maxRange > minRange))
    throw Error("range image: max_range_m must be more than min_range_m, and that not negative");
}

}  // namespace polemcl
