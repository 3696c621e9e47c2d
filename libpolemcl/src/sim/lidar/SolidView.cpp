#include "sim/lidar/SolidView.h"

#include <algorithm>
#include <cmath>

#include <polemcl/core/common/Types.h>

namespace polemcl::sim {

BeamView::BeamView(const Beam& beam, double divergence)
    : start(0, 0, static_cast<float>(beam.rise)), azimuth(beam.azimuth), halfAngle(divergence / 2) {
  // A Gaussian pulse has about 0.4 of its peak at 0.35 of the full angle.
  const double aside = 0.35 * divergence;
  const double yaw[kSubRays] = {0, aside, -aside, 0, 0}, pitch[kSubRays] = {0, 0, 0, aside, -aside};
  const double elevation = beam.elevation + beam.elevationError;
  for (int s = 0; s < kSubRays; ++s) {
    const double a = beam.azimuth + yaw[s] / std::cos(elevation), e = elevation + pitch[s];
    m_local[s] = Eigen::Vector3d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e))
                     .cast<float>();
  }
  m_reported = {std::cos(beam.elevation) * std::cos(azimuth),
                std::cos(beam.elevation) * std::sin(azimuth), std::sin(beam.elevation)};
  lowTangent = std::tan(elevation - divergence);
  highTangent = std::tan(elevation + divergence);
}

Eigen::Vector3d BeamView::reported(const ColumnView& column, double range) const {
  return {range * (column.reportedCosine * m_reported.x() - column.reportedSine * m_reported.y()),
          range * (column.reportedSine * m_reported.x() + column.reportedCosine * m_reported.y()),
          range * m_reported.z() + start.z()};
}

SolidView::SolidView(const Solid& solid, const Eigen::Isometry3d& T_sensor_map, std::uint64_t seed)
    : material(solid.material),
      object(solid.object),
      m_shape(solid.shape),
      m_position(T_sensor_map * solid.position),
      m_axes(T_sensor_map.linear() * solid.axes),
      m_size(solid.size.cast<float>()),
      m_density(solid.density),
      m_cell(solid.cell),
      m_seed(seed) {
  toLocal = m_axes.transpose().cast<float>();
  offset = (-(m_axes.transpose() * m_position)).cast<float>();
}

ShapeHit SolidView::intersect(const LocalRay& ray, std::uint64_t draw) const {
  ShapeHit hit;
  if (m_shape == Shape::frustum) {
    hit = hitFrustum(ray, m_size.x(), m_size.y(), m_size.z());
  } else if (m_shape == Shape::box) {
    hit = hitBox(ray, m_size);
  } else if (m_density <= 0) {
    hit = hitEllipsoid(ray, m_size);
  } else {
    int face = 0;
    const auto [enter, leave] =
        m_shape == Shape::ellipsoid ? crossEllipsoid(ray, m_size) : crossBox(ray, m_size, face);
    return hitLeaves(ray, enter, leave, m_density, m_cell, m_seed, unitFloat(hash(draw)));
  }
  if (material.passes > 0 && std::isfinite(hit.range) && unitFloat(hash(draw)) < material.passes)
    return {};
  return hit;
}

void SolidView::boundFrustum(SolidBounds& bounds, double margin, double& low, double& high,
                             double& farthest) const {
  const double radius = std::max(m_size.x(), m_size.y()) + margin;
  const Eigen::Vector3d end = m_position + m_size.z() * m_axes.col(2);
  const Eigen::Vector2d a = m_position.head<2>(), b = end.head<2>();
  const double square = (b - a).squaredNorm();
  const double share = square > 0 ? std::clamp(-a.dot(b - a) / square, 0.0, 1.0) : 0.0;
  bounds.nearest = (a + share * (b - a)).norm() - radius;
  farthest = std::max(a.norm(), b.norm()) + radius;
  low = std::min(m_position.z(), end.z()) - radius;
  high = std::max(m_position.z(), end.z()) + radius;
  if (bounds.nearest < 0.1) return;
  const double first = std::atan2(a.y(), a.x()), firstHalf = std::asin(radius / a.norm());
  const double second = wrapAngle(std::atan2(b.y(), b.x()) - first),
               secondHalf = std::asin(radius / b.norm());
  const double from = std::min(-firstHalf, second - secondHalf);
  const double to = std::max(firstHalf, second + secondHalf);
  bounds.azimuth = first + 0.5 * (from + to);
  bounds.halfAzimuth = 0.5 * (to - from);
}

void SolidView::boundBox(SolidBounds& bounds, double margin, double& low, double& high,
                         double& farthest) const {
  const Eigen::Vector3d size = m_size.cast<double>();
  const Eigen::Vector3d origin = offset.cast<double>();  // position of the sensor in the box frame
  const double aside = std::hypot(std::max(std::abs(origin.x()) - size.x(), 0.0),
                                  std::max(std::abs(origin.y()) - size.y(), 0.0));
  // Boxes are vertical; the sensor may tilt by a few degrees, so that heights add to distances.
  bounds.nearest = 0.97 * aside - 0.1 * (std::abs(origin.z()) + size.z()) - margin;
  const double middle = std::atan2(m_position.y(), m_position.x());
  double from = 0, to = 0;
  low = 1e9, high = -1e9, farthest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const Eigen::Vector3d point = m_position + m_axes * size.cwiseProduct(sign);
    const double aimed = wrapAngle(std::atan2(point.y(), point.x()) - middle);
    from = std::min(from, aimed);
    to = std::max(to, aimed);
    low = std::min(low, point.z() - margin);
    high = std::max(high, point.z() + margin);
    farthest = std::max(farthest, point.head<2>().norm() + margin);
  }
  if (bounds.nearest < 0.1) return;
  bounds.azimuth = middle + 0.5 * (from + to);
  bounds.halfAzimuth = 0.5 * (to - from) + margin / bounds.nearest;
}

void SolidView::boundEllipsoid(SolidBounds& bounds, double margin, double& low, double& high,
                               double& farthest) const {
  const double across = std::max(m_size.x(), m_size.y()) + 0.1 * m_size.z() + margin;
  const double upright = m_size.z() + 0.1 * std::max(m_size.x(), m_size.y()) + margin;
  const double distance = m_position.head<2>().norm();
  bounds.nearest = distance - across;
  farthest = distance + across;
  low = m_position.z() - upright;
  high = m_position.z() + upright;
  if (bounds.nearest < 0.1) return;
  bounds.azimuth = std::atan2(m_position.y(), m_position.x());
  bounds.halfAzimuth = std::asin(across / distance);
}

SolidBounds SolidView::bounds(const BoundsMargin& margin) const {
  SolidBounds bounds;
  double low = 0, high = 0, farthest = 0;
  if (m_shape == Shape::frustum)
    boundFrustum(bounds, margin.translation, low, high, farthest);
  else if (m_shape == Shape::ellipsoid)
    boundEllipsoid(bounds, margin.translation, low, high, farthest);
  else
    boundBox(bounds, margin.translation, low, high, farthest);
  if (bounds.nearest < 0.1) {
    bounds.nearest = 0;
    return bounds;
  }
  low -= margin.highestRise;
  high -= margin.lowestRise;
  bounds.lowTangent = low / (low < 0 ? bounds.nearest : farthest);
  bounds.highTangent = high / (high > 0 ? bounds.nearest : farthest);
  bounds.halfAzimuth += margin.azimuth;
  return bounds;
}

}  // namespace polemcl::sim
