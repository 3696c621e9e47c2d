#pragma once
/// \file TiltEstimation.h
/// \brief Tilt of the sensor, from the poles of one scan.
///
/// A LiDAR on a cambered road or a slope sees every upright pole with the same tilt. The ground
/// does not show it, because the vehicle stands on that ground. The tilt of one pole is known
/// poorly, and some trunks are tilted; all poles together are reliable.

#include <Eigen/Core>
#include <vector>

namespace polemcl {

/// \brief Tilt of a fitted pole, LiDAR frame.
struct PoleTilt {
  Eigen::Vector2f tilt{0, 0};  ///< along x and y, m per m of height, shrunk towards upright
  /// Share of the prior, that poles are upright, in `tilt`; in (0, 1], 1 for what is seen at one
  /// height only.
  float prior = 1;
  /// Counts so much, in [0, 1]: how far the pole's confidence lies above that of those left out, so
  /// that what is found in one scan and not in the next moves nothing.
  float weight = 1;
  float step = 0;  ///< from the mean height of the fitted segments to that of the centre, m
  float gap = 0;   ///< from there to the height of the sensor, m: 0 where the segments reach it
};

/// Standard deviation of a pole's tilt by which it is shrunk, m per m.
constexpr double tiltSigma = 0.02;

/// \brief The tilt that the poles have in common: robust mean of the tilts as they were seen, each
/// weighted by how well it is known, shrunk towards `upright`, which it is without poles.
/// \param upright Tilt of an upright pole as known before, m per m.
Eigen::Vector2f estimateTilt(const std::vector<PoleTilt>& poles, const Eigen::Vector2f& upright);

/// \brief How far the centre of a pole moves when `common` takes the place of `upright` in the
/// prior, and its axis is followed to the height of the sensor where it was not seen, m.
Eigen::Vector2f shiftBy(const PoleTilt& pole, const Eigen::Vector2f& upright,
                        const Eigen::Vector2f& common);

}  // namespace polemcl
