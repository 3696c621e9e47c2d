#pragma once
/// \file Intersection.h
/// \brief Intersection of rays with shapes, each in the shape's own frame. All kernels use single
/// precision and first move the origin near the shape: distant origins would cost centimetres on
/// thin posts.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/common/Random.h"
#include "sim/world/Solid.h"

namespace polemcl::sim {

/// \brief A ray in the frame of a shape; `direction` is a unit vector.
struct LocalRay {
  Eigen::Vector3f origin, direction;
};

/// \brief Nearest hit in front of the origin: range in m, and the cosine of incidence.
struct ShapeHit {
  float range = std::numeric_limits<float>::infinity();
  float cosine = 1;
  bool operator<(const ShapeHit& other) const { return range < other.range; }
};

/// \brief Cone between radius `r0` at z = 0 and `r1` at z = `length`, with both caps.
inline ShapeHit hitFrustum(const LocalRay& ray, float r0, float r1, float length) {
  ShapeHit hit;
  const Eigen::Vector3f& d = ray.direction;
  const float shift = -(ray.origin - Eigen::Vector3f(0, 0, length / 2)).dot(d);
  const Eigen::Vector3f o = ray.origin + shift * d;
  const float slope = (r1 - r0) / length;
  const float radius = r0 + slope * o.z(), growth = slope * d.z();
  const float a = d.x() * d.x() + d.y() * d.y() - growth * growth;
  const float b = o.x() * d.x() + o.y() * d.y() - radius * growth;
  const float c = o.x() * o.x() + o.y() * o.y() - radius * radius;
  const float discriminant = b * b - a * c;
  if (discriminant < 0 && c > 0 && a > 0) return hit;
  if (std::abs(a) > 1e-9f && discriminant >= 0) {
    const float t = (-b - std::sqrt(discriminant)) / a, z = o.z() + t * d.z();
    if (t + shift > 0 && z >= 0 && z <= length) {
      hit.range = t + shift;
      const Eigen::Vector3f normal(o.x() + t * d.x(), o.y() + t * d.y(), -slope * (r0 + slope * z));
      hit.cosine = std::abs(normal.dot(d)) / std::max(normal.norm(), 1e-6f);
    }
  }
  if (std::abs(d.z()) < 1e-6f) return hit;
  const float level = d.z() > 0 ? 0.0f : length, rim = d.z() > 0 ? r0 : r1;
  const float t = (level - o.z()) / d.z();
  const float x = o.x() + t * d.x(), y = o.y() + t * d.y();
  if (t + shift > 0 && t + shift < hit.range && x * x + y * y <= rim * rim) {
    hit.range = t + shift;
    hit.cosine = std::abs(d.z());
  }
  return hit;
}

/// \brief Interval of ranges inside an axis-aligned box around the origin; empty if first > second.
/// \param face Set to the axis of the face that the ray enters.
inline std::pair<float, float> crossBox(const LocalRay& ray, const Eigen::Vector3f& half,
                                        int& face) {
  float enter = -std::numeric_limits<float>::infinity(), leave = -enter;
  for (int i = 0; i < 3; ++i) {
    const float inverse =
        1.0f / (std::abs(ray.direction[i]) < 1e-9f ? std::copysign(1e-9f, ray.direction[i])
                                                   : ray.direction[i]);
    const float one = (-half[i] - ray.origin[i]) * inverse;
    const float two = (half[i] - ray.origin[i]) * inverse;
    if (std::min(one, two) > enter) {
      enter = std::min(one, two);
      face = i;
    }
    leave = std::min(leave, std::max(one, two));
  }
  return {enter, leave};
}

inline ShapeHit hitBox(const LocalRay& ray, const Eigen::Vector3f& half) {
  ShapeHit hit;
  int face = 0;
  const auto [enter, leave] = crossBox(ray, half, face);
  if (enter > leave || enter <= 0) return hit;
  hit.range = enter;
  hit.cosine = std::abs(ray.direction[face]);
  return hit;
}

/// \brief Interval of ranges inside an ellipsoid; empty if first > second.
inline std::pair<float, float> crossEllipsoid(const LocalRay& ray, const Eigen::Vector3f& half) {
  const float shift = -ray.origin.dot(ray.direction);
  const Eigen::Vector3f o = (ray.origin + shift * ray.direction).cwiseQuotient(half);
  const Eigen::Vector3f d = ray.direction.cwiseQuotient(half);
  const float a = d.squaredNorm(), b = o.dot(d), c = o.squaredNorm() - 1;
  const float discriminant = b * b - a * c;
  if (discriminant < 0) return {1, -1};
  const float root = std::sqrt(discriminant);
  return {(-b - root) / a + shift, (-b + root) / a + shift};
}

inline ShapeHit hitEllipsoid(const LocalRay& ray, const Eigen::Vector3f& half) {
  ShapeHit hit;
  const auto [enter, leave] = crossEllipsoid(ray, half);
  if (enter > leave || enter <= 0) return hit;
  hit.range = enter;
  const Eigen::Vector3f point = ray.origin + enter * ray.direction;
  const Eigen::Vector3f normal = point.cwiseQuotient(half).cwiseQuotient(half);
  hit.cosine = std::abs(normal.dot(ray.direction)) / std::max(normal.norm(), 1e-6f);
  return hit;
}

/// \brief Steps through leaf cells from `enter` to `leave`; the first filled cell is the hit. Cells
/// are filled by a hash of their position, in clumps with gaps, so that leaves look the same from
/// everywhere.
/// \param jitter In [0, 1): position of the leaf within the cell.
inline ShapeHit hitLeaves(const LocalRay& ray, float enter, float leave, float density, float cell,
                          std::uint64_t seed, float jitter) {
  ShapeHit hit;
  enter = std::max(enter, 0.0f);
  if (!(enter < leave)) return hit;
  const Eigen::Vector3f start = ray.origin + enter * ray.direction;
  int index[3], step[3];
  float next[3], width[3];
  for (int i = 0; i < 3; ++i) {
    index[i] = static_cast<int>(std::floor(start[i] / cell));
    step[i] = ray.direction[i] < 0 ? -1 : 1;
    const float speed = std::max(std::abs(ray.direction[i]), 1e-9f);
    width[i] = cell / speed;
    const float edge = static_cast<float>(index[i] + (step[i] > 0 ? 1 : 0)) * cell;
    next[i] = enter + std::abs(edge - start[i]) / speed;
  }
  for (float range = enter; range < leave;) {
    const int axis = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    const auto key = [](int x, int y, int z) {
      return (static_cast<std::uint64_t>(x + 4096) << 40) ^
             (static_cast<std::uint64_t>(y + 4096) << 20) ^ static_cast<std::uint64_t>(z + 4096);
    };
    const std::uint64_t leaf = hash(seed ^ key(index[0], index[1], index[2]));
    const float draw = unitFloat(leaf);
    const bool grazed =
        std::min(next[axis], leave) - range < 1e-4f;  // only touches a corner of the cell
    if (draw < 2 * density && !grazed) {              // clumps: up to twice the density
      const std::uint64_t clump = hash(~seed ^ key(index[0] >> 2, index[1] >> 2, index[2] >> 2));
      if (draw < density * 2 * unitFloat(clump)) {
        const float end = std::min(next[axis], leave);
        hit.range = range + jitter * (end - range);
        hit.cosine = 0.3f + 0.7f * unitFloat(hash(leaf));
        return hit;
      }
    }
    range = next[axis];
    next[axis] += width[axis];
    index[axis] += step[axis];
  }
  return hit;
}

}  // namespace polemcl::sim
