#pragma once
/// \file TrajectoryEvaluation.h
/// \brief Trajectory errors, in the authors' ways.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/export.h>

namespace polemcl {

struct PoseError {
  double time = 0;
  double position = 0;      ///< Euclidean in the plane, m
  double lateral = 0;       ///< signed, + left of the true heading, m
  double longitudinal = 0;  ///< signed, + ahead, m
  double heading = 0;       ///< signed, rad, wrapped
};

/// \brief Summary over poses. lat/lon/ang means are of absolute values.
struct TrajectoryErrors {
  double posMean = 0, posRmse = 0, posMax = 0;  ///< m
  double latMean = 0, lonMean = 0;              ///< m
  double angMeanDeg = 0, angRmseDeg = 0;        ///< degrees
  std::size_t poses = 0;                        ///< compared
  /// perPose: estimates outside the time span of the truth, or in a gap of it.
  /// perMetre: metres of the true path, between the first and the last estimate, in a gap of
  /// either.
  std::size_t unmatched = 0;
  std::vector<PoseError> errors;  ///< by time, one for each pose compared
};

enum class Sampling {
  perPose,  ///< at each estimate
  perMetre  ///< at 0, 1, 2, … m along the true path since the first estimate (NCLT protocol)
};

/// \brief Longest gap between two samples of the truth that is interpolated across, s.
inline constexpr double longestTruthGap = 2.0;

/// \brief Compares in 2D, convergence included. Between its samples the truth is interpolated in
/// time, linearly in x and y and the shorter way round in heading; so is the estimate for perMetre.
/// \param truth,estimate Robot poses in the same map frame, finite, times increasing.
/// \param maxTruthGap Samples further apart than this are not interpolated across, s. At a sample
///        itself (within 2 µs, as files round times) no neighbour is needed.
/// \throws Error when either is empty, holds a number that is not finite or times that do not
///         increase, or when less than half of the estimates (for perMetre, of the metres too) can
///         be compared.
POLEMCL_EXPORT TrajectoryErrors evaluateTrajectory(const std::vector<StampedPose2D>& truth,
                                                   const std::vector<StampedPose2D>& estimate,
                                                   Sampling sampling,
                                                   double maxTruthGap = longestTruthGap);

/// \brief Distance driven along the true path at the time of each error, m; constant outside it.
POLEMCL_EXPORT std::vector<double> distanceDriven(const std::vector<StampedPose2D>& truth,
                                                  const std::vector<PoseError>& errors);

/// \brief evaluateTrajectory() with Sampling::perPose, one estimate at a time, in constant memory.
class POLEMCL_EXPORT TrajectoryEvaluator {
 public:
  /// \param truth Must outlive this object. \throws Error as evaluateTrajectory().
  explicit TrajectoryEvaluator(const std::vector<StampedPose2D>& truth,
                               double maxTruthGap = longestTruthGap);

  /// \brief The next estimate. \return Its error; nothing where there is no truth.
  /// \throws Error when it is not finite, or not later than the one before.
  std::optional<PoseError> add(const StampedPose2D& estimate);
  /// \brief Estimates taken so far.
  std::size_t estimates() const { return m_estimates; }
  /// \brief The summary; its `errors` stay empty.
  /// \throws Error without an estimate, or when less than half of them can be compared.
  TrajectoryErrors finish() const;

 private:
  const std::vector<StampedPose2D>& m_truth;
  double m_maxTruthGap;
  TrajectoryErrors m_sums;  ///< not yet divided; of squares, where it will hold a root
  StampedPose2D m_first, m_last;
  std::size_t m_estimates = 0;
};

}  // namespace polemcl
