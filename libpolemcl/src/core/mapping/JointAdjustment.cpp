#include "core/mapping/JointAdjustment.h"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "core/common/Transform.h"

namespace polemcl {
namespace {

constexpr double kMotionSigma = 0.003;  ///< m: of each motion, beyond what it states
constexpr double kTurnSigma = 3e-4;     ///< rad: the same
constexpr double kExact = 1e-3;         ///< m: added to what is known of an anchor's place
constexpr double kAnywhere = 1e3;       ///< m, rad: keeps what nothing holds from falling out

constexpr const char* kOpen = "the drives cannot be adjusted: odometry and poles leave them open";

template <int size>
using Square = Eigen::Matrix<double, size, size>;

/// The matrix whose product with a residual has the covariance 1.
template <int size>
Square<size> whitening(const Square<size>& covariance) {
  const Square<size> information = symmetrized<size>(covariance.inverse());
  return information.llt().matrixU();
}

/// Geman and McClure's: far pairs cost no more than the constant.
class FadingLoss : public ceres::LossFunction {
 public:
  void Evaluate(double squared, double out[3]) const override {
    const double sum = kQuarterWeight + squared, share = kQuarterWeight / sum;
    out[0] = squared * share;
    out[1] = share * share;
    out[2] = -2 * share * share / sum;
  }
};

template <class T>
T wrapped(const T& angle) {
  using std::floor;
  return angle - 2 * M_PI * floor((angle + M_PI) / (2 * M_PI));
}

/// A motion from pose `a` to pose `b` against what it should be.
template <class T>
Eigen::Matrix<T, 3, 1> beyond(const T* a, const T* b, const T& x, const T& y, const T& yaw) {
  using std::cos;
  using std::sin;
  const T c = cos(a[2]), s = sin(a[2]), dx = b[0] - a[0], dy = b[1] - a[1];
  return {c * dx + s * dy - x, c * dy - s * dx - y, wrapped<T>(b[2] - a[2] - yaw)};
}

struct OdometryCost {
  Pose2D read;
  Eigen::Matrix3d white;
  template <class T>
  bool operator()(const T* a, const T* b, const T* errors, T* residual) const {
    const T scale = 1.0 + errors[0];
    Eigen::Map<Eigen::Matrix<T, 3, 1>> out(residual);
    out = white * beyond<T>(a, b, scale * read.x, scale * read.y, read.yaw + errors[1] * read.x);
    return true;
  }
};

struct TieCost {
  Pose2D motion;
  Eigen::Matrix3d white;
  template <class T>
  bool operator()(const T* a, const T* b, T* residual) const {
    Eigen::Map<Eigen::Matrix<T, 3, 1>> out(residual);
    out = white * beyond<T>(a, b, T(motion.x), T(motion.y), T(motion.yaw));
    return true;
  }
};

struct KnownPoseCost {
  Pose2D known;
  Eigen::Matrix3d white;
  template <class T>
  bool operator()(const T* pose, T* residual) const {
    Eigen::Map<Eigen::Matrix<T, 3, 1>> out(residual);
    out = white * Eigen::Matrix<T, 3, 1>(pose[0] - known.x, pose[1] - known.y,
                                         wrapped<T>(pose[2] - known.yaw));
    return true;
  }
};

struct SightingCost {
  Eigen::Vector2d seen;
  Eigen::Matrix2d white;
  template <class T>
  bool operator()(const T* pose, const T* pole, T* residual) const {
    using std::cos;
    using std::sin;
    const T c = cos(pose[2]), s = sin(pose[2]), dx = pole[0] - pose[0], dy = pole[1] - pose[1];
    const Eigen::Matrix<T, 2, 1> error(c * dx + s * dy - seen.x(), c * dy - s * dx - seen.y());
    Eigen::Map<Eigen::Matrix<T, 2, 1>> out(residual);
    out = white * error;
    return true;
  }
};

/// A position beyond what pose, antenna and lasting error make of it.
struct FixCost {
  PositionFix fix;
  double sigma;
  template <class T>
  bool operator()(const T* a, const T* b, const T* error, const T* antenna, T* residual) const {
    using std::cos;
    using std::sin;
    const T c = cos(a[2]), s = sin(a[2]), share(fix.share);
    residual[0] = (a[0] + share * (b[0] - a[0]) + c * antenna[0] - s * antenna[1] + error[0] -
                   fix.position.x()) /
                  sigma;
    residual[1] = (a[1] + share * (b[1] - a[1]) + s * antenna[0] + c * antenna[1] + error[1] -
                   fix.position.y()) /
                  sigma;
    return true;
  }
};

struct LastingCost {
  double correlation, sigma;
  template <class T>
  bool operator()(const T* before, const T* now, T* residual) const {
    for (int axis = 0; axis < 2; ++axis)
      residual[axis] = (now[axis] - correlation * before[axis]) / sigma;
    return true;
  }
};

ceres::LossFunction* fading(double share) {
  return new ceres::ScaledLoss(new FadingLoss, share, ceres::TAKE_OWNERSHIP);
}

}  // namespace

std::vector<std::size_t> drivesOf(const std::vector<DrivenScan>& scans) {
  std::vector<std::size_t> drives;
  for (const DrivenScan& scan : scans) {
    const bool begins = drives.empty() || !scan.motion;
    drives.push_back(drives.empty() ? 0 : drives.back() + (begins ? 1 : 0));
  }
  return drives;
}

struct JointAdjustment::Impl {
  Impl(const std::vector<DrivenScan>& drivenScans, const AdjustmentTrust& adjustmentTrust,
       AdjustedState& adjusted)
      : scans(drivenScans), trust(adjustmentTrust), state(adjusted) {}
  double* pose(std::size_t scan) { return &state.poses[scan].x; }
  double* pole(std::size_t index) { return state.poles[index].data(); }

  void addMotions();
  void addSighting(const PoleSighting& sighting);
  void addAnchor(const PoleAnchor& anchor);
  void addTie(const PoseTie& tie);
  void addKnown(const KnownPose& known);
  void addFixes(const FixFactors& gnss);
  Eigen::SparseMatrix<double> information();
  double newShare(std::size_t scan) const;

  const std::vector<DrivenScan>& scans;
  const AdjustmentTrust& trust;
  AdjustedState& state;
  ceres::Problem problem;
};

void JointAdjustment::Impl::addMotions() {
  const std::vector<std::size_t> drives = drivesOf(scans);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    double* errors = state.odometry[drives[i]].data();
    if (i == 0 || !scans[i].motion) {  // a drive begins
      const Eigen::Matrix2d sigmas =
          Eigen::Vector2d(1 / trust.scaleSigma, 1 / trust.yawSigma).asDiagonal();
      problem.AddResidualBlock(new ceres::NormalPrior(sigmas, Eigen::Vector2d::Zero()), nullptr,
                               errors);
      problem.AddParameterBlock(pose(i), 3);
      continue;
    }
    Eigen::Matrix3d covariance = scans[i].motion->covariance;
    covariance.diagonal() += Eigen::Vector3d(kMotionSigma, kMotionSigma, kTurnSigma).cwiseAbs2();
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<OdometryCost, 3, 3, 3, 2>(
                                 new OdometryCost{scans[i].motion->mean, whitening<3>(covariance)}),
                             nullptr, pose(i - 1), pose(i), errors);
  }
}

/// Scans near each other show a pole from the same side, with the same error.
double JointAdjustment::Impl::newShare(std::size_t scan) const {
  if (!scans[scan].motion || scan == 0) return 1;
  const Pose2D& motion = scans[scan].motion->mean;
  return std::clamp(std::hypot(motion.x, motion.y) / trust.decorrelation, 1e-3, 1.0);
}

void JointAdjustment::Impl::addSighting(const PoleSighting& sighting) {
  const PoleDetection& seen = scans[sighting.scan].poles_robot[sighting.detection];
  const Eigen::Matrix2d covariance =
      seen.covariance + trust.poleSigma * trust.poleSigma * Eigen::Matrix2d::Identity();
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<SightingCost, 2, 3, 2>(
                               new SightingCost{centreOf(seen), whitening<2>(covariance)}),
                           fading(newShare(sighting.scan) * seen.confidence), pose(sighting.scan),
                           pole(sighting.pole));
}

void JointAdjustment::Impl::addAnchor(const PoleAnchor& anchor) {
  const Eigen::Matrix2d covariance =
      anchor.known.covariance + kExact * kExact * Eigen::Matrix2d::Identity();
  problem.AddResidualBlock(new ceres::NormalPrior(whitening<2>(covariance), centreOf(anchor.known)),
                           fading(anchor.known.confidence), pole(anchor.pole));
}

void JointAdjustment::Impl::addTie(const PoseTie& tie) {
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<TieCost, 3, 3, 3>(
                               new TieCost{tie.motion.mean, whitening<3>(tie.motion.covariance)}),
                           nullptr, pose(tie.first), pose(tie.second));
}

void JointAdjustment::Impl::addKnown(const KnownPose& known) {
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<KnownPoseCost, 3, 3>(new KnownPoseCost{
                               known.pose.mean, whitening<3>(known.pose.covariance)}),
                           nullptr, pose(known.scan));
}

ceres::CostFunction* priorOf(const Eigen::Vector2d& mean, double sigma) {
  return new ceres::NormalPrior(Eigen::Matrix2d::Identity() / sigma, mean);
}

void JointAdjustment::Impl::addFixes(const FixFactors& gnss) {
  if (gnss.fixes.empty()) return;
  for (std::size_t i = 0; i < gnss.errors.size(); ++i) {
    double* error = state.fixErrors[i].data();
    const LastingError& lasting = gnss.errors[i];
    if (lasting.correlation <= 0) {
      problem.AddResidualBlock(priorOf(Eigen::Vector2d::Zero(), lasting.sigma), nullptr, error);
      continue;
    }
    const double fresh = lasting.sigma * std::sqrt(1 - std::pow(lasting.correlation, 2));
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<LastingCost, 2, 2, 2>(
                                 new LastingCost{lasting.correlation, fresh}),
                             nullptr, state.fixErrors[i - 1].data(), error);
  }
  for (std::size_t i = 0; i < gnss.antennas.size(); ++i)
    problem.AddResidualBlock(priorOf(gnss.antennas[i].stated, gnss.antennas[i].sigma), nullptr,
                             state.antennas[i].data());
  const std::vector<std::size_t> drives = drivesOf(scans);
  for (const PositionFix& fix : gnss.fixes)
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<FixCost, 2, 3, 3, 2, 2>(
                                 new FixCost{fix, gnss.widening * fix.sigma}),
                             fading(1), pose(fix.scan), pose(fix.scan + 1),
                             state.fixErrors[fix.error].data(),
                             state.antennas[drives[fix.scan]].data());
}

JointAdjustment::JointAdjustment(const std::vector<DrivenScan>& scans, const AdjustmentTrust& trust,
                                 const AdjustmentFactors& factors, AdjustedState& state)
    : m_impl(std::make_unique<Impl>(scans, trust, state)) {
  m_impl->addMotions();
  for (const PoleSighting& sighting : factors.sightings) m_impl->addSighting(sighting);
  for (const PoleAnchor& anchor : factors.anchors) m_impl->addAnchor(anchor);
  for (const PoseTie& tie : factors.ties) m_impl->addTie(tie);
  for (const KnownPose& known : factors.known) m_impl->addKnown(known);
  m_impl->addFixes(factors.gnss);
}

JointAdjustment::~JointAdjustment() = default;

void JointAdjustment::solve(int iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // Eigen's solver gives the same bytes on any machine; one thread, always the same order.
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.num_threads = 1;
  options.max_num_iterations = iterations;
  // Long drives bend at little cost: full steps, and no end before they are straight.
  options.initial_trust_region_radius = 1e12;
  options.function_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &m_impl->problem, &summary);
  if (!summary.IsSolutionUsable()) throw Error(kOpen);
  for (Pose2D& pose : m_impl->state.poses) pose.yaw = wrapAngle(pose.yaw);
}

/// Information of all unknowns: the poses first, three each, then the rest.
Eigen::SparseMatrix<double> JointAdjustment::Impl::information() {
  ceres::Problem::EvaluateOptions options;
  for (Pose2D& pose : state.poses) options.parameter_blocks.push_back(&pose.x);
  for (Eigen::Vector2d& errors : state.odometry) options.parameter_blocks.push_back(errors.data());
  for (auto* places : {&state.poles, &state.fixErrors, &state.antennas})
    for (Eigen::Vector2d& place : *places)
      if (problem.HasParameterBlock(place.data())) options.parameter_blocks.push_back(place.data());
  ceres::CRSMatrix rows;
  problem.Evaluate(options, nullptr, nullptr, nullptr, &rows);
  const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>> jacobian(
      rows.num_rows, rows.num_cols, static_cast<Eigen::Index>(rows.values.size()), rows.rows.data(),
      rows.cols.data(), rows.values.data());
  Eigen::SparseMatrix<double> result = jacobian.transpose() * jacobian;
  Eigen::SparseMatrix<double> anywhere(rows.num_cols, rows.num_cols);
  anywhere.setIdentity();
  result += anywhere / (kAnywhere * kAnywhere);
  return result;
}

/// Factored so that some unknowns come last: their part of the factor holds their covariance.
Eigen::MatrixXd covarianceOf(const Eigen::SparseMatrix<double>& information,
                             const std::vector<Eigen::Index>& unknowns) {
  using Permutation = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;
  Permutation order;
  Eigen::AMDOrdering<int>()(information.selfadjointView<Eigen::Lower>(), order);
  std::vector<bool> asked(static_cast<std::size_t>(information.rows()));
  for (const Eigen::Index unknown : unknowns) asked[static_cast<std::size_t>(unknown)] = true;
  std::vector<int> sequence;
  for (Eigen::Index i = 0; i < order.size(); ++i)
    if (!asked[static_cast<std::size_t>(order.indices()[i])])
      sequence.push_back(order.indices()[i]);
  for (const Eigen::Index unknown : unknowns) sequence.push_back(static_cast<int>(unknown));
  Permutation places(information.rows());  // of each unknown in the sequence
  for (std::size_t i = 0; i < sequence.size(); ++i)
    places.indices()[sequence[i]] = static_cast<int>(i);
  Eigen::SparseMatrix<double> permuted(information.rows(), information.cols());
  permuted = information.twistedBy(places);
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>>
      factored(permuted);
  if (factored.info() != Eigen::Success) throw Error(kOpen);
  const auto count = static_cast<Eigen::Index>(unknowns.size());
  const Eigen::SparseMatrix<double> lower = factored.matrixL();
  const Eigen::MatrixXd last = lower.bottomRightCorner(count, count);
  const Eigen::MatrixXd inverse =
      last.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(count, count));
  return inverse.transpose() * inverse;
}

Eigen::MatrixXd JointAdjustment::poseCovariance(const std::vector<std::size_t>& scans) const {
  std::vector<Eigen::Index> unknowns;
  for (const std::size_t scan : scans)
    for (int axis = 0; axis < 3; ++axis)
      unknowns.push_back(static_cast<Eigen::Index>(3 * scan) + axis);
  Eigen::MatrixXd covariance = covarianceOf(m_impl->information(), unknowns);
  if (!covariance.allFinite()) throw Error(kOpen);
  return covariance;
}

}  // namespace polemcl
