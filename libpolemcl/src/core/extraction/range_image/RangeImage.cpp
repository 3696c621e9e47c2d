#include "core/extraction/range_image/RangeImage.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

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

namespace {

/// Eq. 1 in the precision `Real`.
template <class Real>
class Projection {
 public:
  Projection(const RangeImageOptions& options, double minRange, double heightOffset)
      : m_options(options),
        m_minRange(static_cast<Real>(minRange)),
        m_minZ(static_cast<Real>(options.minZ - heightOffset)),
        m_maxZ(static_cast<Real>(options.maxZ - heightOffset)),
        m_fovDown(static_cast<Real>(-options.fovDown)),
        m_fov(static_cast<Real>(options.fovUp - options.fovDown)) {}

  struct Point {
    Real x, y, z, range;
  };
  Point point(const PointsView& points, std::size_t i) const {
    const auto real = [&](float v) {
      return static_cast<Real>(exactCoordinate(v, m_options.coordinateStep));
    };
    Point p{real(points.x[i]), real(points.y[i]), real(points.z[i]), 0};
    if (m_options.mirrored) p.y = -p.y;
    p.range = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    return p;
  }
  bool inRange(const Point& p) const {
    return p.range >= m_minRange && p.range < static_cast<Real>(m_options.maxRange) &&
           p.z > m_minZ && p.z < m_maxZ;
  }
  /// Row and column; may lie outside the image. The row is NaN where squares of coordinates are too
  /// small for Real: then z may exceed the range.
  std::pair<double, double> pixel(const Point& p) const {
    const Real pi = static_cast<Real>(M_PI);
    const Real u = Real(0.5) * (1 - std::atan2(p.y, p.x) / pi);
    // The angle added is the one below the horizon, so that row 0 is the topmost beam.
    const Real v = 1 - (std::asin(p.z / p.range) + m_fovDown) / m_fov;
    return {std::floor(v * static_cast<Real>(m_options.rows)),
            std::floor(u * static_cast<Real>(m_options.columns))};
  }

 private:
  const RangeImageOptions& m_options;
  Real m_minRange, m_minZ, m_maxZ, m_fovDown, m_fov;
};

template <class Real>
PointCounts projectIn(const PointsView& points, const RangeImageOptions& options, double minRange,
                      double heightOffset, RangeImage& image) {
  const Projection<Real> projection(options, minRange, heightOffset);
  PointCounts counts;
  for (std::size_t i = 0; i < points.size; ++i) {
    const auto p = projection.point(points, i);
    if (!std::isfinite(p.range) || p.range == 0) {
      ++counts.invalid;
      continue;
    }
    if (!projection.inRange(p)) {
      ++counts.outOfRange;
      continue;
    }
    auto [v, u] = projection.pixel(p);
    const bool clamps = options.details == ExtractionDetails::authors;
    if (clamps ? std::isnan(v) : !(v >= 0 && v < image.rows())) {
      ++counts.outOfView;
      continue;
    }
    if (clamps) {
      v = std::clamp(v, 0.0, image.rows() - 1.0);
      u = std::min(u, image.columns() - 1.0);
    }
    const int row = static_cast<int>(v);
    const int column = static_cast<int>(u) % image.columns();  // azimuth -pi is azimuth pi
    if (image.valid(row, column)) {
      ++counts.hidden;
      if (p.range >= projection.point(points, image.point(row, column)).range) continue;
    } else {
      ++counts.used;
    }
    image.set(row, column, static_cast<float>(p.range), static_cast<std::int32_t>(i));
  }
  return counts;
}

}  // namespace

PointCounts project(const PointsView& points, const RangeImageOptions& options, double minRange,
                    double heightOffset, RangeImage& image) {
  if (!(minRange >= 0 && options.maxRange > minRange))
    throw Error("range image: max_range_m must be more than min_range_m, and that not negative");
  image.clear();
  const auto run = options.singlePrecision ? projectIn<float> : projectIn<double>;
  return run(points, options, minRange, heightOffset, image);
}

}  // namespace polemcl
