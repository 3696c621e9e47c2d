#pragma once
/// \file OdometryDrift.h
/// \brief Uncertainty of dead reckoning between two moments of a drive.

#include <Eigen/Core>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>

namespace polemcl {

/// \brief Running sums over the steps of a drive; the difference of two states gives the
/// uncertainty added between them, to first order and in closed form.
///
/// A step that ends at p_k with position noise N_k and heading noise ω_k moves a place m that was
/// fixed before it, seen from after it, by -n_k - ω_k·J·(m - p_k) with J a quarter turn. Steps are
/// independent, so the covariances add up, and the sums of ω_k², ω_k²·p_k and ω_k²·p_k·p_kᵀ are all
/// that has to be kept of the way.
class POLEMCL_EXPORT OdometryDrift {
 public:
  /// \brief One step more.
  /// \param end Where the step ends, local frame, m.
  /// \param yaw Heading before the step, local frame, rad.
  /// \param covariance Covariance of the step's (x, y, yaw) in the robot frame before it,
  ///        m², m·rad, rad². Its correlations of position and heading are not used.
  void add(const Eigen::Vector2d& end, double yaw, const Eigen::Matrix3d& covariance);

  /// \brief Covariance of `place` (local frame, m), known exactly from the robot at the moment
  /// `then`, as seen from the robot `now`; m², along the axes of the local frame.
  /// \param then A state of the same drive, not later than `now`.
  static Eigen::Matrix2d between(const OdometryDrift& then, const OdometryDrift& now,
                                 const Eigen::Vector2d& place);

  /// \brief The state counted from a later one, with sums about another origin (local frame, m).
  /// between() gives the same for states that were all counted anew. Far from the origin, the
  /// differences of the sums would be lost in rounding.
  OdometryDrift countedFrom(const OdometryDrift& zero, const Eigen::Vector2d& origin) const;
  const Eigen::Vector2d& origin() const { return m_origin; }  ///< of the sums, local frame, m

 private:
  Eigen::Vector2d m_origin = Eigen::Vector2d::Zero();    ///< p_k are from here, m
  Eigen::Matrix2d m_position = Eigen::Matrix2d::Zero();  ///< Σ N_k, m²
  double m_heading = 0;                                  ///< Σ ω_k², rad²
  Eigen::Vector2d m_first = Eigen::Vector2d::Zero();     ///< Σ ω_k² p_k
  Eigen::Matrix2d m_second = Eigen::Matrix2d::Zero();    ///< Σ ω_k² p_k p_kᵀ
};

}  // namespace polemcl
